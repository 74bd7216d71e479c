// Compiled once for each instruction set; see base/row.hpp for what that forbids.
// Over 300 lines: the loop over a block and all that it inlines must be compiled together.
#include "kernels/crush_rows.hpp"

#include "base/row.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

BIRM3D_INLINE void add_to(double* sum, const Row& row) {
    (Row::load(sum) + row).store(sum);
}

struct Vector {
    Row x, y, z;
};

BIRM3D_INLINE Row dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The way of a node to the surface for each unit of gap, and the direction `share` by which the force of its truss becomes
// a normal force (see crush.hpp).
struct Place {
    Vector way, share;
};

// Both give the places of the eight nodes from i on. A flat surface takes arriving nodes along n.
struct Flat {
    BIRM3D_INLINE explicit Flat(const FlatPress& s)
        : n{s.nx, s.ny, s.nz}, h{s.hx, s.hy, s.hz}, offset(s.offset) {}
    BIRM3D_INLINE Row gap(std::size_t, const Vector& node) const { return dot(n, node) - offset; }
    BIRM3D_INLINE Place at(std::size_t, const Row& F0) const {
        const Row zero = 0.0;
        return {{where_above(F0, zero, h.x, n.x), where_above(F0, zero, h.y, n.y),
                 where_above(F0, zero, h.z, n.z)},
                n};
    }
    // Of nodes that an indentation draws in, above zero.
    BIRM3D_INLINE Row drawn(std::size_t) const { return 0.0; }
    Vector n, h;
    Row offset;
};

struct Curved {
    BIRM3D_INLINE explicit Curved(const CurvedPress& press) : s(press) {}
    BIRM3D_INLINE Row gap(std::size_t i, const Vector&) const { return Row::load(s.gap + i); }
    BIRM3D_INLINE Vector normal(std::size_t i) const {
        return {Row::load(s.nx + i), Row::load(s.ny + i), Row::load(s.nz + i)};
    }
    // Where normals part sharply, at an edge, the one before says nothing of the path.
    BIRM3D_INLINE Place at(std::size_t i, const Row& F0) const {
        const Row zero = 0.0, one = 1.0;
        const Vector n = normal(i);
        const Vector b{Row::load(s.bx + i), Row::load(s.by + i), Row::load(s.bz + i)};
        const Row cosine = dot(n, b), per_force = Row::load(s.per_force + i);
        const Row follows = where_above(F0, zero, where_above(cosine, sharp_turn, one, zero), zero);
        const Row mean = 1.0 / (1.0 + follows * cosine);
        const auto way = [&](const Row& own, const Row& before) {
            return where_above(per_force, zero, before, (own + follows * before) * mean);
        };
        const auto share = [&](const Row& own, const Row& before) {
            return where_above(per_force, zero, before * per_force, own);
        };
        return {{way(n.x, b.x), way(n.y, b.y), way(n.z, b.z)},
                {share(n.x, b.x), share(n.y, b.y), share(n.z, b.z)}};
    }
    BIRM3D_INLINE Row drawn(std::size_t i) const { return Row::load(s.per_force + i); }
    // Of a unit of normal force; keeps it, and the place, for later.
    BIRM3D_INLINE Vector torque(std::size_t i, const Vector& node, const Vector& n) const {
        const Row of_dent = drawn(i), zero = 0.0;
        const auto keep = [&](double* column, const Row& found) {
            const Row kept = where_above(of_dent, zero, Row::load(column + i), found);
            kept.store(column + i);
            return kept;
        };
        keep(s.px, node.x);
        keep(s.py, node.y);
        keep(s.pz, node.z);
        return {keep(s.tx, node.y * n.z - node.z * n.y), keep(s.ty, node.z * n.x - node.x * n.z),
                keep(s.tz, node.x * n.y - node.y * n.x)};
    }
    BIRM3D_INLINE Row inverse_mass(const Vector& t) const {
        return s.mass + (t.x * (s.xx * t.x + s.xy * t.y + s.xz * t.z) + t.y * (s.yy * t.y + s.yz * t.z) +
                         s.zz * t.z * t.z);
    }
    BIRM3D_INLINE void leave(std::size_t i) const {
        double* const columns[] = {s.px, s.py, s.pz, s.tx, s.ty, s.tz};
        for (double* column : columns)
            Row(0.0).store(column + i);
    }
    const CurvedPress s;  // a copy, which no column can overlap
};

template <bool recovers>
BIRM3D_INLINE void copy(const PressState<const double>& before, const PressState<double>& now,
                        std::size_t i) {
    Row::load(before.x + i).store(now.x + i);
    Row::load(before.y + i).store(now.y + i);
    Row::load(before.z + i).store(now.z + i);
    Row::load(before.deflection + i).store(now.deflection + i);
    Row::load(before.force + i).store(now.force + i);
    Row::load(before.peak_deflection + i).store(now.peak_deflection + i);
    Row::load(before.residual + i).store(now.residual + i);
    if constexpr (recovers) Row::load(before.unloading + i).store(now.unloading + i);
}

// The slope of unloading of each truss, and where its line meets zero force. A truss that loads sets them anew.
struct Unloading {
    Row slope, residual;
    BIRM3D_INLINE Row line(const Row& d) const {
        const Row zero = 0.0;
        return greater(slope * (d - residual), zero);
    }
};

// Fig. 3: the slope is constant.
BIRM3D_INLINE Row load_one_slope(const PressColumns& truss, Unloading& of, const Row& d, const Row& line,
                                 const Row& envelope, std::size_t i) {
    const Row compliance = Row::load(truss.compliance + i);
    of.residual = where_above(line, envelope, d - envelope * compliance, of.residual);
    return compliance;
}

// What is left of the truss gives back a constant share of its length (truss_law.hpp). A truss may load and unload with one
// slope at first.
BIRM3D_INLINE Row load_recovery(const PressColumns& truss, Unloading& of, const Row& d, const Row& line,
                                const Row& envelope, std::size_t i) {
    const Row zero = 0.0, one = 1.0;
    const auto where_loading = [&](const Row& now, const Row& else_) {
        return where_above(envelope, zero, where_above(envelope, line, else_, now), else_);
    };
    const Row least = tolerance::truss_length, length = Row::load(truss.length + i);
    const Row per_recovery = Row::load(truss.per_recovery + i) * length / greater(length - d, least);
    const Row steepest = greater(envelope * per_recovery, Row::load(truss.k_unloading + i));
    of.slope = where_loading(steepest, of.slope);
    const Row compliance = where_above(of.slope, zero, one / of.slope, zero);
    of.residual = where_loading(d - envelope * compliance, of.residual);
    return compliance;
}

// The nodes of the row at i whose truss ceased to push. One that follows a receding surface stops where its truss reaches
// zero force; one that the truss pushes off the surface springs to that length at once, and what the truss had stored is
// lost, which an indentation keeps at its surface all the same. Returns what the first kind takes from twice the work on the
// trusses (J).
template <class Surface>
Row release(const PressColumns& truss, const Surface& surface, const PressState<const double>& before,
            const PressState<double>& now, std::size_t i, const Row& gap) {
    const Row zero = 0.0, one = 1.0, least = tolerance::truss_length;
    const Row F0 = Row::load(before.force + i), d0 = Row::load(before.deflection + i);
    const Row d1 = Row::load(now.deflection + i), slack = Row::load(before.residual + i);
    const Vector anchor{Row::load(truss.anchor_x + i), Row::load(truss.anchor_y + i),
                        Row::load(truss.anchor_z + i)};
    const Vector from{Row::load(before.x + i), Row::load(before.y + i), Row::load(before.z + i)};
    const Vector to{Row::load(now.x + i), Row::load(now.y + i), Row::load(now.z + i)};
    const Vector share = surface.at(i, F0).share;
    const Row drawn = surface.drawn(i);
    const Row points =
        dot({anchor.x - to.x, anchor.y - to.y, anchor.z - to.z}, share);  // above zero: into the surface
    const Row ceased = where_above(Row::load(now.force + i), zero, zero, F0);

    const Row way = d0 - d1;
    const Row part = where_above(way, zero, greater(lesser((d0 - slack) / way, one), zero), zero);
    const Row d = where_above(points, zero, d0 - part * way, slack);
    // Drawn out beyond its length it stays: back there it would be inside.
    const Row returns = where_above(drawn, zero, zero, where_above(d1, slack, one, zero));
    const Row moves = where_above(ceased, zero, where_above(points, zero, gap, returns), zero);

    const auto along = [&](const Row& a, const Row& start, const Row& end) {
        return where_above(points, zero, start + part * (end - start) - a, end - a);
    };
    const Vector b{along(anchor.x, from.x, to.x), along(anchor.y, from.y, to.y),
                   along(anchor.z, from.z, to.z)};
    const Row length = Row::load(truss.length + i) - d;
    const Row scale = where_above(length, least, length / square_root(dot(b, b)), one);
    where_above(moves, zero, anchor.x + scale * b.x, to.x).store(now.x + i);
    where_above(moves, zero, anchor.y + scale * b.y, to.y).store(now.y + i);
    where_above(moves, zero, anchor.z + scale * b.z, to.z).store(now.z + i);
    where_above(moves, zero, d, d1).store(now.deflection + i);
    const Row kept = where_above(drawn, zero, where_above(points, zero, zero, ceased), zero);
    const Row residual = Row::load(now.residual + i);
    where_above(kept, zero, greater(slack, d1), residual).store(now.residual + i);
    return where_above(moves, zero, where_above(points, zero, F0 * (d - d1), zero), zero);
}

// Takes the nodes of a block that are at the surface onto it: their places, deflections and the shares of their truss
// forces along the normal, which stand in for the normal forces until these are known. Rows of which no node pushes or
// is inside stay as they are, and are not `pressed`.
template <bool flat, bool recovers, class Surface>
BIRM3D_INLINE void hold(const PressColumns& truss, const Surface& surface,
                        const PressState<const double>& before, const PressState<double>& now, double* gaps,
                        double* shares, bool* pressed) {
    const Row zero = 0.0, one = 1.0, least = tolerance::truss_length;
    for (std::size_t i = 0; i < block_size; i += row_length) {
        const Vector from{Row::load(before.x + i), Row::load(before.y + i), Row::load(before.z + i)};
        const Row F0 = Row::load(before.force + i);
        const Row gap = surface.gap(i, from);
        gap.store(gaps + i);
        pressed[i / row_length] = any_above(greater(F0, -1.0 * gap), zero);
        if (!pressed[i / row_length]) {
            copy<recovers>(before, now, i);
            zero.store(shares + i);
            if constexpr (!flat) surface.leave(i);
            continue;
        }
        const Place place = surface.at(i, F0);
        const Row way = where_above(zero, gap, gap, where_above(F0, zero, gap, zero));
        const Vector node{from.x - way * place.way.x, from.y - way * place.way.y, from.z - way * place.way.z};

        // From the node to its anchor. A bottomed-out truss has no direction of its own any more: it presses along n.
        const Vector b{Row::load(truss.anchor_x + i) - node.x, Row::load(truss.anchor_y + i) - node.y,
                       Row::load(truss.anchor_z + i) - node.z};
        const Row length = square_root(dot(b, b));
        const Row share = where_above(length, least, greater(dot(b, place.share), zero) / length, one);
        node.x.store(now.x + i);
        node.y.store(now.y + i);
        node.z.store(now.z + i);
        (Row::load(truss.length + i) - length).store(now.deflection + i);
        share.store(shares + i);
    }
}

// Two rounds over the rows, so that the square roots and divisions of several are under way at a time.
template <bool flat, bool recovers, class Surface>
BIRM3D_INLINE PressedNodes press(const PressColumns& truss, const Surface& surface,
                                 const PressState<const double>& before, const PressState<double>& now,
                                 double* gaps, double* pressures, NodeSums& sums) {
    const Row zero = 0.0, one = 1.0;
    Row force = zero, work = zero, stored = zero, pushing = zero;
    bool ceased = false;
    Row stiffness = zero;
    Vector moment{zero, zero, zero}, push{zero, zero, zero};
    bool pressed[block_size / row_length];
    hold<flat, recovers>(truss, surface, before, now, gaps, pressures, pressed);
    for (std::size_t i = 0; i < block_size; i += row_length) {
        if (!pressed[i / row_length]) continue;
        const Row F0 = Row::load(before.force + i), gap = Row::load(gaps + i);
        const Row d = Row::load(now.deflection + i), share = Row::load(pressures + i);

        // Fig. 3: the loading envelope by the changes of slope at its hinges, and the unloading line below it.
        Row envelope = zero;
        for (std::size_t j = 0; j < truss.hinges; ++j) {
            const double* hinge = truss.hinge + j * 2 * block_size + i;
            envelope = envelope + Row::load(hinge + block_size) * greater(d - Row::load(hinge), zero);
        }
        if (truss.factor != nullptr) envelope = envelope * Row::load(truss.factor + i);
        const double* const slopes = recovers ? before.unloading : truss.k_unloading;
        Unloading unloading{Row::load(slopes + i), Row::load(before.residual + i)};
        const Row line = unloading.line(d);
        // A truss that would push its node off the surface does not push at all.
        const Row law = where_above(share, zero, where_above(line, envelope, envelope, line), zero);
        const Row F = where_above(zero, gap, law, where_above(F0, zero, law, zero));
        const Row pressure = F * share;

        F.store(now.force + i);
        greater(d, Row::load(before.peak_deflection + i)).store(now.peak_deflection + i);
        const Row compliance = recovers ? load_recovery(truss, unloading, d, line, envelope, i)
                                        : load_one_slope(truss, unloading, d, line, envelope, i);
        unloading.residual.store(now.residual + i);
        if constexpr (recovers) unloading.slope.store(now.unloading + i);
        pressure.store(pressures + i);

        const Vector node{Row::load(now.x + i), Row::load(now.y + i), Row::load(now.z + i)};
        force = force + pressure;
        if constexpr (flat) {
            moment = {moment.x + pressure * node.x, moment.y + pressure * node.y,
                      moment.z + pressure * node.z};
        } else {
            const Vector n = surface.normal(i);
            push = {push.x + pressure * n.x, push.y + pressure * n.y, push.z + pressure * n.z};
            const Vector torque = surface.torque(i, node, n);
            moment = {moment.x + pressure * torque.x, moment.y + pressure * torque.y,
                      moment.z + pressure * torque.z};
            const Row k = unloading.slope * greater(share * share, one);
            stiffness = stiffness + where_above(F, zero, k * surface.inverse_mass(torque), zero);
        }
        work = work + (F0 + F) * (d - Row::load(before.deflection + i));
        stored = stored + F * F * compliance;
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
                        double* pressures, NodeSums& sums);
PressedNodes press_curved(const PressColumns& truss, const CurvedPress& surface,
                          const PressState<const double>& before, const PressState<double>& now, double* gaps,
                          double* pressures, NodeSums& sums);

PressedNodes press_flat(const PressColumns& truss, const FlatPress& surface,
                        const PressState<const double>& before, const PressState<double>& now, double* gaps,
                        double* pressures, NodeSums& sums) {
    if (truss.per_recovery != nullptr)
        return press<true, true>(truss, Flat(surface), before, now, gaps, pressures, sums);
    return press<true, false>(truss, Flat(surface), before, now, gaps, pressures, sums);
}

PressedNodes press_curved(const PressColumns& truss, const CurvedPress& surface,
                          const PressState<const double>& before, const PressState<double>& now, double* gaps,
                          double* pressures, NodeSums& sums) {
    if (truss.per_recovery != nullptr)
        return press<false, true>(truss, Curved(surface), before, now, gaps, pressures, sums);
    return press<false, false>(truss, Curved(surface), before, now, gaps, pressures, sums);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
