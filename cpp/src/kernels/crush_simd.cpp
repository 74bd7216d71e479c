// Compiled once for each instruction set; see base/packet.hpp for what that forbids.
// Over 300 lines: the loop over a block and all that it inlines must be compiled together.
#include "kernels/crush_simd.hpp"

#include <type_traits>

#include "base/packet.hpp"
#include "birm3d/base/tolerances.hpp"
#include "birm3d/model/recovery.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

BIRM3D_INLINE void add_to(double* sum, const Packet& row) {
    (Packet::load(sum) + row).store(sum);
}

struct Vector {
    Packet x, y, z;
};

BIRM3D_INLINE Packet dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// In place of the projection of a force that would push its node off the surface.
constexpr double pushes_off = -1.0;

// Flat and Curved have the same members. direction(i) is that in which each of the eight nodes from i on moves onto the
// surface, for each unit of gap. The product of projector(i) with the truss's unit vector turns the truss force into a
// normal force (see crush.hpp). Nodes that arrive at a flat surface are moved along n.
struct Flat {
    BIRM3D_INLINE explicit Flat(const FlatPress& s)
        : n{s.nx, s.ny, s.nz}, h{s.hx, s.hy, s.hz}, offset(s.offset) {}
    BIRM3D_INLINE Packet gap(std::size_t, const Vector& node) const { return dot(n, node) - offset; }
    BIRM3D_INLINE Vector direction(std::size_t, const Packet& F0) const {
        const Packet zero = 0.0;
        return {where_above(F0, zero, h.x, n.x), where_above(F0, zero, h.y, n.y),
                where_above(F0, zero, h.z, n.z)};
    }
    BIRM3D_INLINE const Vector& projector(std::size_t) const { return n; }
    // Above zero for nodes that follow an indentation.
    BIRM3D_INLINE Packet drawn(std::size_t) const { return 0.0; }
    Vector n, h;
    Packet offset;
};

struct Curved {
    BIRM3D_INLINE explicit Curved(const CurvedPress& press) : s(press) {}
    BIRM3D_INLINE Packet gap(std::size_t i, const Vector&) const { return Packet::load(s.gap + i); }
    BIRM3D_INLINE Vector normal(std::size_t i) const {
        return {Packet::load(s.nx + i), Packet::load(s.ny + i), Packet::load(s.nz + i)};
    }
    // At an edge normals differ sharply; then the normal before is not used for the path.
    BIRM3D_INLINE Vector before(std::size_t i) const {
        return {Packet::load(s.bx + i), Packet::load(s.by + i), Packet::load(s.bz + i)};
    }
    BIRM3D_INLINE Vector direction(std::size_t i, const Packet& F0) const {
        const Packet zero = 0.0, one = 1.0;
        const Vector n = normal(i), b = before(i);
        const Packet cosine = dot(n, b), per_force = Packet::load(s.per_force + i);
        const Packet follows = where_above(F0, zero, where_above(cosine, sharp_edge, one, zero), zero);
        const Packet mean = 1.0 / (1.0 + follows * cosine);
        const auto path = [&](const Packet& own, const Packet& last) {
            return where_above(per_force, zero, last, (own + follows * last) * mean);
        };
        return {path(n.x, b.x), path(n.y, b.y), path(n.z, b.z)};
    }
    BIRM3D_INLINE Vector projector(std::size_t i) const {
        const Packet zero = 0.0, per_force = Packet::load(s.per_force + i);
        const Vector n = normal(i), b = before(i);
        const auto along = [&](const Packet& own, const Packet& last) {
            return where_above(per_force, zero, last * per_force, own);
        };
        return {along(n.x, b.x), along(n.y, b.y), along(n.z, b.z)};
    }
    BIRM3D_INLINE Packet drawn(std::size_t i) const { return Packet::load(s.per_force + i); }
    // Torque of a unit normal force. Stores it and the place of the node, which friction needs.
    BIRM3D_INLINE Vector torque(std::size_t i, const Vector& node, const Vector& n) const {
        const Packet of_indentation = drawn(i), zero = 0.0;
        const auto keep = [&](double* column, const Packet& found) {
            const Packet kept = where_above(of_indentation, zero, Packet::load(column + i), found);
            kept.store(column + i);
            return kept;
        };
        keep(s.px, node.x);
        keep(s.py, node.y);
        keep(s.pz, node.z);
        return {keep(s.tx, node.y * n.z - node.z * n.y), keep(s.ty, node.z * n.x - node.x * n.z),
                keep(s.tz, node.x * n.y - node.y * n.x)};
    }
    BIRM3D_INLINE Packet inverse_mass(const Vector& t) const {
        return s.mass + (t.x * (s.xx * t.x + s.xy * t.y + s.xz * t.z) + t.y * (s.yy * t.y + s.yz * t.z) +
                         s.zz * t.z * t.z);
    }
    BIRM3D_INLINE void leave(std::size_t i) const {
        double* const columns[] = {s.px, s.py, s.pz, s.tx, s.ty, s.tz};
        for (double* column : columns)
            Packet(0.0).store(column + i);
    }
    const CurvedPress s;  // a copy, which no column can overlap
};

template <bool recovers>
BIRM3D_INLINE void copy(const PressState<const double>& before, const PressState<double>& now,
                        std::size_t i) {
    Packet::load(before.x + i).store(now.x + i);
    Packet::load(before.y + i).store(now.y + i);
    Packet::load(before.z + i).store(now.z + i);
    Packet::load(before.deflection + i).store(now.deflection + i);
    Packet::load(before.force + i).store(now.force + i);
    Packet::load(before.peak_deflection + i).store(now.peak_deflection + i);
    Packet::load(before.residual + i).store(now.residual + i);
    if constexpr (recovers) Packet::load(before.unloading + i).store(now.unloading + i);
}

// Fig. 3: below the envelope a truss is on a line of constant slope, which meets zero force at `residual`. A truss that
// loads sets it anew.
struct UnloadingLine {
    BIRM3D_INLINE UnloadingLine(const PressColumns& truss, const PressState<const double>& before,
                                std::size_t i)
        : slope(Packet::load(truss.k_unloading + i)),
          compliance(Packet::load(truss.compliance + i)),
          residual(Packet::load(before.residual + i)) {}
    BIRM3D_INLINE Packet force(const Packet& d) const {
        const Packet zero = 0.0;
        return greater(slope * (d - residual), zero);
    }
    BIRM3D_INLINE void load(const Packet& d, const Packet& unloading, const Packet& envelope) {
        residual = where_above(unloading, envelope, d - envelope * compliance, residual);
    }
    BIRM3D_INLINE Packet tangent(const Packet&, const Packet&) const { return slope; }
    BIRM3D_INLINE Packet twice_stored(const Packet&, const Packet& F) const { return F * F * compliance; }
    BIRM3D_INLINE void store(const PressState<double>& now, std::size_t i) const {
        residual.store(now.residual + i);
    }
    Packet slope, compliance, residual;
};

// Trusses with a recovery unload along F = coefficient (d - residual)^n, others along a line (truss_law.hpp).
struct UnloadingCurve {
    BIRM3D_INLINE UnloadingCurve(const PressColumns& truss_, const PressState<const double>& before,
                                 std::size_t i_)
        : truss(truss_),
          i(i_),
          recovery(Packet::load(truss_.recovery + i_)),
          coefficient(Packet::load(before.unloading + i_)),
          residual(Packet::load(before.residual + i_)),
          force_before(Packet::load(before.force + i_)),
          deflection_before(Packet::load(before.deflection + i_)) {}
    // The first where a truss unloads along a line, else the second: has_recovery() for eight trusses.
    BIRM3D_INLINE Packet where_line(const Packet& line, const Packet& curve) const {
        const Packet longest = longest_recovery;
        return where_above(recovery, longest, line, curve);
    }
    BIRM3D_INLINE Packet power(const Packet& u) const {
        return where_line(power_by_squares<line_degree>(u), power_by_squares<recovery_degree>(u));
    }
    BIRM3D_INLINE Packet degree() const { return where_line(line_degree, recovery_degree); }
    BIRM3D_INLINE Packet force(const Packet& d) const {
        const Packet zero = 0.0;
        return coefficient * power(greater(d - residual, zero));
    }
    // The length r at which all work of this step on the truss is stored. Never more is: what was crushed stays crushed.
    BIRM3D_INLINE Packet by_energy(const Packet& d, const Packet& envelope) const {
        const Packet zero = 0.0, least = tolerance::truss_length;
        const Packet stored = force_before * greater(deflection_before - residual, zero);
        const Packet work = 0.5 * (degree() + 1.0) * (force_before + envelope) * (d - deflection_before);
        return where_line(longest_recovery, greater((stored + work) / envelope, least));
    }
    BIRM3D_INLINE void load(const Packet& d, const Packet& unloading, const Packet& envelope) {
        const Packet zero = 0.0, least = tolerance::truss_length, length = Packet::load(truss.length + i);
        const auto where_loading = [&](const Packet& now, const Packet& else_) {
            return where_above(envelope, zero, where_above(envelope, unloading, else_, now), else_);
        };
        const Packet uncrushed = greater(length - d, least) / length;
        const Packet by_slope = degree() * envelope * Packet::load(truss.compliance + i);
        const Packet R = lesser(lesser(lesser(recovery * uncrushed, d), by_slope), by_energy(d, envelope));
        coefficient = where_loading(envelope / power(R), coefficient);
        residual = where_loading(d - R, residual);
    }
    BIRM3D_INLINE Packet tangent(const Packet& d, const Packet& F) const {
        const Packet least = tolerance::truss_length;
        return unloading_tangent(degree(), F, greater(d - residual, least));
    }
    BIRM3D_INLINE Packet twice_stored(const Packet& d, const Packet& F) const {
        const Packet zero = 0.0;
        return F * greater(d - residual, zero) * (2.0 / (degree() + 1.0));
    }
    BIRM3D_INLINE void store(const PressState<double>& now, std::size_t) const {
        coefficient.store(now.unloading + i);
        residual.store(now.residual + i);
    }
    const PressColumns& truss;
    std::size_t i;
    Packet recovery, coefficient, residual;
    Packet force_before, deflection_before;  // as the step began (N, m)
};

// Releases the nodes of the packet at i whose trusses have stopped pushing. A node on a receding surface stops where
// its truss reaches zero force. A truss that pushes its node off the surface extends at once to that length, and its
// stored energy is lost. An indentation keeps such a node at its surface. Returns the correction of twice the work on
// the trusses of nodes that a receding surface released (J).
template <class Surface>
Packet release(const PressColumns& truss, const Surface& surface, const PressState<const double>& before,
               const PressState<double>& now, std::size_t i, const Packet& gap) {
    const Packet zero = 0.0, one = 1.0, least = tolerance::truss_length;
    const Packet F0 = Packet::load(before.force + i), d0 = Packet::load(before.deflection + i);
    const Packet d1 = Packet::load(now.deflection + i), slack = Packet::load(before.residual + i);
    const Vector anchor{Packet::load(truss.anchor_x + i), Packet::load(truss.anchor_y + i),
                        Packet::load(truss.anchor_z + i)};
    const Vector from{Packet::load(before.x + i), Packet::load(before.y + i), Packet::load(before.z + i)};
    const Vector to{Packet::load(now.x + i), Packet::load(now.y + i), Packet::load(now.z + i)};
    const Vector& projector = surface.projector(i);
    const Packet drawn = surface.drawn(i);
    const Packet points =
        dot({anchor.x - to.x, anchor.y - to.y, anchor.z - to.z}, projector);  // above zero: into the surface
    const Packet ceased = where_above(Packet::load(now.force + i), zero, zero, F0);

    const Packet extension = d0 - d1;
    const Packet part =
        where_above(extension, zero, greater(lesser((d0 - slack) / extension, one), zero), zero);
    const Packet d = where_above(points, zero, d0 - part * extension, slack);
    // A node that is held beyond the free length stays: at that length it would be inside the surface.
    const Packet returns = where_above(drawn, zero, zero, where_above(d1, slack, one, zero));
    const Packet moves = where_above(ceased, zero, where_above(points, zero, gap, returns), zero);

    const auto along = [&](const Packet& a, const Packet& start, const Packet& end) {
        return where_above(points, zero, start + part * (end - start) - a, end - a);
    };
    const Vector b{along(anchor.x, from.x, to.x), along(anchor.y, from.y, to.y),
                   along(anchor.z, from.z, to.z)};
    const Packet length = Packet::load(truss.length + i) - d;
    const Packet scale = where_above(length, least, length / square_root(dot(b, b)), one);
    where_above(moves, zero, anchor.x + scale * b.x, to.x).store(now.x + i);
    where_above(moves, zero, anchor.y + scale * b.y, to.y).store(now.y + i);
    where_above(moves, zero, anchor.z + scale * b.z, to.z).store(now.z + i);
    where_above(moves, zero, d, d1).store(now.deflection + i);
    const Packet kept = where_above(drawn, zero, where_above(points, zero, zero, ceased), zero);
    const Packet residual = Packet::load(now.residual + i);
    where_above(kept, zero, greater(slack, d1), residual).store(now.residual + i);
    return where_above(moves, zero, where_above(points, zero, F0 * (d - d1), zero), zero);
}

// Moves the nodes of a block that are at the surface onto it. Sets their places, deflections, and projections of
// truss forces on the normal, stored in place of the normal forces. Packets of which no node pushes or is inside stay
// as they are, and are not `pressed`.
template <bool flat, bool recovers, class Surface>
BIRM3D_INLINE void hold(const PressColumns& truss, const Surface& surface,
                        const PressState<const double>& before, const PressState<double>& now, double* gaps,
                        double* projections, bool* pressed) {
    const Packet zero = 0.0, one = 1.0, least = tolerance::truss_length,
                 in_surface = -tolerance::touching_gap;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        const Vector from{Packet::load(before.x + i), Packet::load(before.y + i), Packet::load(before.z + i)};
        const Packet F0 = Packet::load(before.force + i);
        const Packet gap = surface.gap(i, from);
        gap.store(gaps + i);
        pressed[i / packet_length] = any_above(greater(F0, -1.0 * gap), zero);
        if (!pressed[i / packet_length]) {
            copy<recovers>(before, now, i);
            zero.store(projections + i);
            if constexpr (!flat) surface.leave(i);
            continue;
        }
        const Vector direction = surface.direction(i, F0);
        const Vector& projector = surface.projector(i);
        const Packet depth = where_above(zero, gap, gap, where_above(F0, zero, gap, zero));
        const Vector node{from.x - depth * direction.x, from.y - depth * direction.y,
                          from.z - depth * direction.z};

        // From the node to its anchor. A bottomed-out truss has no direction; its force acts along n. A truss that
        // lies in the surface, as where the rigid body stands at it, keeps its force, of which nothing acts along n.
        const Vector b{Packet::load(truss.anchor_x + i) - node.x, Packet::load(truss.anchor_y + i) - node.y,
                       Packet::load(truss.anchor_z + i) - node.z};
        const Packet length = square_root(dot(b, b)), outside = dot(b, projector);
        const Packet along_normal =
            where_above(outside, in_surface, greater(outside, zero) / length, pushes_off);
        const Packet projection = where_above(length, least, along_normal, one);
        node.x.store(now.x + i);
        node.y.store(now.y + i);
        node.z.store(now.z + i);
        (Packet::load(truss.length + i) - length).store(now.deflection + i);
        projection.store(projections + i);
    }
}

// Two passes over the packets, so that square roots and divisions of several packets overlap.
// Over 60 lines: one loop over the packets, whose sums stay in registers.
template <bool flat, class Unloading, class Surface>
BIRM3D_INLINE PressedNodes press(const PressColumns& truss, const Surface& surface,
                                 const PressState<const double>& before, const PressState<double>& now,
                                 double* gaps, double* normal_forces, NodeSums& sums) {
    const Packet zero = 0.0, one = 1.0;
    Packet force = zero, work = zero, stored = zero, pushing = zero;
    bool ceased = false;
    Packet stiffness = zero;
    Vector moment{zero, zero, zero}, push{zero, zero, zero};
    bool pressed[block_size / packet_length];
    constexpr bool recovers = std::is_same_v<Unloading, UnloadingCurve>;
    hold<flat, recovers>(truss, surface, before, now, gaps, normal_forces, pressed);
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        if (!pressed[i / packet_length]) continue;
        const Packet F0 = Packet::load(before.force + i), gap = Packet::load(gaps + i);
        const Packet d = Packet::load(now.deflection + i), projection = Packet::load(normal_forces + i);

        // Fig. 3: the loading envelope by the changes of slope at its hinges, and unloading below it.
        Packet envelope = zero;
        for (std::size_t j = 0; j < truss.hinges; ++j) {
            const double* hinge = truss.hinge + j * 2 * block_size + i;
            envelope = envelope + Packet::load(hinge + block_size) * greater(d - Packet::load(hinge), zero);
        }
        if (truss.factor != nullptr) envelope = envelope * Packet::load(truss.factor + i);
        Unloading unloading(truss, before, i);
        const Packet below = unloading.force(d);
        // A truss that would push its node off the surface does not push at all.
        const Packet law = where_above(zero, projection, zero, where_above(below, envelope, envelope, below));
        const Packet F = where_above(zero, gap, law, where_above(F0, zero, law, zero));
        const Packet normal_force = F * greater(projection, zero);

        F.store(now.force + i);
        greater(d, Packet::load(before.peak_deflection + i)).store(now.peak_deflection + i);
        unloading.load(d, below, envelope);
        unloading.store(now, i);
        normal_force.store(normal_forces + i);

        const Vector node{Packet::load(now.x + i), Packet::load(now.y + i), Packet::load(now.z + i)};
        force = force + normal_force;
        if constexpr (flat) {
            moment = {moment.x + normal_force * node.x, moment.y + normal_force * node.y,
                      moment.z + normal_force * node.z};
        } else {
            const Vector n = surface.normal(i);
            push = {push.x + normal_force * n.x, push.y + normal_force * n.y, push.z + normal_force * n.z};
            const Vector torque = surface.torque(i, node, n);
            moment = {moment.x + normal_force * torque.x, moment.y + normal_force * torque.y,
                      moment.z + normal_force * torque.z};
            const Packet k = unloading.tangent(d, F) * greater(projection * projection, one);
            stiffness = stiffness + where_above(F, zero, k * surface.inverse_mass(torque), zero);
        }
        work = work + (F0 + F) * (d - Packet::load(before.deflection + i));
        stored = stored + unloading.twice_stored(d, F);
        pushing = pushing + where_above(F, zero, one, zero);
        if (any_above(where_above(F, zero, zero, F0), zero)) {
            ceased = true;
            work = work + release(truss, surface, before, now, i, gap);
        }
    }
    add_to(sums.force, force);
    add_to(sums.moment_x, moment.x);
    add_to(sums.moment_y, moment.y);
    add_to(sums.moment_z, moment.z);
    if constexpr (!flat) {
        add_to(sums.push_x, push.x);
        add_to(sums.push_y, push.y);
        add_to(sums.push_z, push.z);
        add_to(sums.stiffness, stiffness);
    }
    add_to(sums.twice_work, work);
    add_to(sums.twice_stored, stored);
    return {sum_of(pushing), ceased};
}

}  // namespace

PressedNodes press_flat(const PressColumns& truss, const FlatPress& surface,
                        const PressState<const double>& before, const PressState<double>& now, double* gaps,
                        double* normal_forces, NodeSums& sums);
PressedNodes press_curved(const PressColumns& truss, const CurvedPress& surface,
                          const PressState<const double>& before, const PressState<double>& now, double* gaps,
                          double* normal_forces, NodeSums& sums);

PressedNodes press_flat(const PressColumns& truss, const FlatPress& surface,
                        const PressState<const double>& before, const PressState<double>& now, double* gaps,
                        double* normal_forces, NodeSums& sums) {
    if (truss.recovery != nullptr)
        return press<true, UnloadingCurve>(truss, Flat(surface), before, now, gaps, normal_forces, sums);
    return press<true, UnloadingLine>(truss, Flat(surface), before, now, gaps, normal_forces, sums);
}

PressedNodes press_curved(const PressColumns& truss, const CurvedPress& surface,
                          const PressState<const double>& before, const PressState<double>& now, double* gaps,
                          double* normal_forces, NodeSums& sums) {
    if (truss.recovery != nullptr)
        return press<false, UnloadingCurve>(truss, Curved(surface), before, now, gaps, normal_forces, sums);
    return press<false, UnloadingLine>(truss, Curved(surface), before, now, gaps, normal_forces, sums);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
