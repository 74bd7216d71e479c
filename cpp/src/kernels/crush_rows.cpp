// Compiled once for each instruction set; see base/row.hpp for what that forbids.
#include "kernels/crush_rows.hpp"

#include "base/row.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

BIRM3D_IN_LANE_LOOP void add_to(double* sum, const Row& row) {
    (Row::load(sum) + row).store(sum);
}

struct Vector {
    Row x, y, z;
};

BIRM3D_IN_LANE_LOOP Row dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Where a row of nodes finds the surface. `way` of a node there for each unit of gap, and the direction `share` by which
// the truss force becomes a normal force (see crush.hpp).
struct Place {
    Vector n, way, share;
};

// Both give the places of the eight nodes from i on. A flat surface takes arriving nodes along n.
struct Flat {
    BIRM3D_IN_LANE_LOOP explicit Flat(const FlatPress& s)
        : n{s.nx, s.ny, s.nz}, h{s.hx, s.hy, s.hz}, offset(s.offset) {}
    BIRM3D_IN_LANE_LOOP Row gap(std::size_t, const Vector& node) const { return dot(n, node) - offset; }
    BIRM3D_IN_LANE_LOOP Place at(std::size_t, const Row& F0) const {
        const Row zero = 0.0;
        return {n,
                {where_above(F0, zero, h.x, n.x), where_above(F0, zero, h.y, n.y),
                 where_above(F0, zero, h.z, n.z)},
                n};
    }
    Vector n, h;
    Row offset;
};

struct Curved {
    BIRM3D_IN_LANE_LOOP explicit Curved(const CurvedPress& press) : s(press) {}
    BIRM3D_IN_LANE_LOOP Row gap(std::size_t i, const Vector&) const { return Row::load(s.gap + i); }
    // Where normals part sharply, at an edge, the one before says nothing of the path.
    BIRM3D_IN_LANE_LOOP Place at(std::size_t i, const Row& F0) const {
        const Row zero = 0.0, one = 1.0;
        const Vector n{Row::load(s.nx + i), Row::load(s.ny + i), Row::load(s.nz + i)};
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
        return {n,
                {way(n.x, b.x), way(n.y, b.y), way(n.z, b.z)},
                {share(n.x, b.x), share(n.y, b.y), share(n.z, b.z)}};
    }
    // Of a unit of normal force; keeps it, and the place, for later.
    BIRM3D_IN_LANE_LOOP Vector torque(std::size_t i, const Vector& node, const Vector& n) const {
        const Row drawn = Row::load(s.per_force + i), zero = 0.0;
        const auto keep = [&](double* column, const Row& found) {
            const Row kept = where_above(drawn, zero, Row::load(column + i), found);
            kept.store(column + i);
            return kept;
        };
        keep(s.px, node.x);
        keep(s.py, node.y);
        keep(s.pz, node.z);
        return {keep(s.tx, node.y * n.z - node.z * n.y), keep(s.ty, node.z * n.x - node.x * n.z),
                keep(s.tz, node.x * n.y - node.y * n.x)};
    }
    BIRM3D_IN_LANE_LOOP Row inverse_mass(const Vector& t) const {
        return s.mass + (t.x * (s.xx * t.x + s.xy * t.y + s.xz * t.z) + t.y * (s.yy * t.y + s.yz * t.z) +
                         s.zz * t.z * t.z);
    }
    BIRM3D_IN_LANE_LOOP void leave(std::size_t i) const {
        double* const columns[] = {s.px, s.py, s.pz, s.tx, s.ty, s.tz};
        for (double* column : columns)
            Row(0.0).store(column + i);
    }
    const CurvedPress s;  // a copy, which no column can overlap
};

BIRM3D_IN_LANE_LOOP void copy(const PressState<const double>& before, const PressState<double>& now,
                              std::size_t i) {
    Row::load(before.x + i).store(now.x + i);
    Row::load(before.y + i).store(now.y + i);
    Row::load(before.z + i).store(now.z + i);
    Row::load(before.deflection + i).store(now.deflection + i);
    Row::load(before.force + i).store(now.force + i);
    Row::load(before.peak_deflection + i).store(now.peak_deflection + i);
    Row::load(before.residual + i).store(now.residual + i);
}

template <bool flat, class Surface>
BIRM3D_IN_LANE_LOOP double press(const PressColumns& truss, const Surface& surface,
                                 const PressState<const double>& before, const PressState<double>& now,
                                 double* gaps, double* pressures, NodeSums& sums) {
    const Row zero = 0.0, one = 1.0, least = tolerance::truss_length;
    const Row node_left = left;
    Row force = zero, work = zero, stored = zero, nodes = zero;
    Row stiffness = zero;
    Vector moment{zero, zero, zero}, push{zero, zero, zero};
    for (std::size_t i = 0; i < lanes; i += row_length) {
        const Vector from{Row::load(before.x + i), Row::load(before.y + i), Row::load(before.z + i)};
        const Row F0 = Row::load(before.force + i);
        const Row gap = surface.gap(i, from);
        gap.store(gaps + i);
        // Nodes that neither push nor are inside stay as they are.
        if (!any_above(greater(F0, -1.0 * gap), zero)) {
            copy(before, now, i);
            zero.store(pressures + i);
            if constexpr (!flat) surface.leave(i);
            continue;
        }
        const Place place = surface.at(i, F0);

        // Nodes at the surface go onto it.
        const Row way = where_above(zero, gap, gap, where_above(F0, zero, gap, zero));
        const Vector node{from.x - way * place.way.x, from.y - way * place.way.y, from.z - way * place.way.z};

        // From the node to its anchor. A closed truss has no direction of its own any more: it presses along n.
        const Vector b{Row::load(truss.anchor_x + i) - node.x, Row::load(truss.anchor_y + i) - node.y,
                       Row::load(truss.anchor_z + i) - node.z};
        const Row length = square_root(dot(b, b));
        const Row share = where_above(length, least, greater(dot(b, place.share), zero) / length, one);
        const Row d = Row::load(truss.length + i) - length;

        // Fig. 3: the loading envelope by the changes of slope at its hinges, and the unloading line below it.
        Row envelope = zero;
        for (std::size_t j = 0; j < truss.hinges; ++j) {
            const double* hinge = truss.hinge + j * 2 * lanes + i;
            envelope = envelope + Row::load(hinge + lanes) * greater(d - Row::load(hinge), zero);
        }
        if (truss.factor != nullptr) envelope = envelope * Row::load(truss.factor + i);
        const Row residual = Row::load(before.residual + i), compliance = Row::load(truss.compliance + i);
        const Row line = greater(Row::load(truss.k_unloading + i) * (d - residual), zero);
        // A truss that would push its node off the surface does not push at all.
        const Row law = where_above(share, zero, where_above(line, envelope, envelope, line), zero);
        const Row F = where_above(zero, gap, law, where_above(F0, zero, law, zero));
        const Row pressure = F * share;

        node.x.store(now.x + i);
        node.y.store(now.y + i);
        node.z.store(now.z + i);
        d.store(now.deflection + i);
        F.store(now.force + i);
        greater(d, Row::load(before.peak_deflection + i)).store(now.peak_deflection + i);
        where_above(line, envelope, d - envelope * compliance, residual).store(now.residual + i);
        pressure.store(pressures + i);

        force = force + pressure;
        if constexpr (flat) {
            moment = {moment.x + pressure * node.x, moment.y + pressure * node.y,
                      moment.z + pressure * node.z};
        } else {
            const Vector f{pressure * place.n.x, pressure * place.n.y, pressure * place.n.z};
            push = {push.x + f.x, push.y + f.y, push.z + f.z};
            const Vector torque = surface.torque(i, node, place.n);
            moment = {moment.x + pressure * torque.x, moment.y + pressure * torque.y,
                      moment.z + pressure * torque.z};
            const Row k = Row::load(truss.k_unloading + i) * greater(share * share, one);
            stiffness = stiffness + where_above(F, zero, k * surface.inverse_mass(torque), zero);
        }
        work = work + (F0 + F) * (d - Row::load(before.deflection + i));
        stored = stored + F * F * compliance;
        nodes = nodes + where_above(F, zero, one, where_above(F0, zero, node_left, zero));
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
    return sum_of(nodes);
}

}  // namespace

double press_flat(const PressColumns& truss, const FlatPress& surface, const PressState<const double>& before,
                  const PressState<double>& now, double* gaps, double* pressures, NodeSums& sums);
double press_curved(const PressColumns& truss, const CurvedPress& surface,
                    const PressState<const double>& before, const PressState<double>& now, double* gaps,
                    double* pressures, NodeSums& sums);

double press_flat(const PressColumns& truss, const FlatPress& surface, const PressState<const double>& before,
                  const PressState<double>& now, double* gaps, double* pressures, NodeSums& sums) {
    return press<true>(truss, Flat(surface), before, now, gaps, pressures, sums);
}

double press_curved(const PressColumns& truss, const CurvedPress& surface,
                    const PressState<const double>& before, const PressState<double>& now, double* gaps,
                    double* pressures, NodeSums& sums) {
    return press<false>(truss, Curved(surface), before, now, gaps, pressures, sums);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
