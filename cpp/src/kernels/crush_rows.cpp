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

// `arriving`, `held`: ways of a node for each unit of gap; `share`: see crush_rows.hpp.
struct Place {
    Row gap;
    Vector n, arriving, held, share;
};

// Both give the places of the eight nodes from i on. A flat surface takes arriving nodes along n.
struct Flat {
    BIRM3D_IN_LANE_LOOP explicit Flat(const FlatPress& s)
        : n{s.nx, s.ny, s.nz}, h{s.hx, s.hy, s.hz}, offset(s.offset) {}
    BIRM3D_IN_LANE_LOOP Place at(std::size_t, const Vector& node) const {
        return {dot(n, node) - offset, n, n, h, n};
    }
    Vector n, h;
    Row offset;
};

struct Curved {
    BIRM3D_IN_LANE_LOOP explicit Curved(const CurvedPress& press) : s(press) {}
    BIRM3D_IN_LANE_LOOP Place at(std::size_t i, const Vector&) const {
        const Vector way{Row::load(s.hx + i), Row::load(s.hy + i), Row::load(s.hz + i)};
        return {Row::load(s.gap + i),
                {Row::load(s.nx + i), Row::load(s.ny + i), Row::load(s.nz + i)},
                way,
                way,
                {Row::load(s.sx + i), Row::load(s.sy + i), Row::load(s.sz + i)}};
    }
    // Of a unit of normal force; keeps it, and the place, for later.
    BIRM3D_IN_LANE_LOOP Vector torque(std::size_t i, const Vector& node, const Vector& n) const {
        const Row drawn = Row::load(s.drawn + i), zero = 0.0;
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
    const CurvedPress& s;
};

template <bool flat, class Surface>
BIRM3D_IN_LANE_LOOP double press(const PressColumns& truss, const Surface& surface,
                                 const PressState<const double>& before, const PressState<double>& now,
                                 double* gaps, double* pressures, NodeSums& sums) {
    const Row zero = 0.0, one = 1.0, least = tolerance::truss_length;
    const Row node_left = left;
    Row force = zero, work = zero, stored = zero, nodes = zero;
    Vector moment{zero, zero, zero}, push{zero, zero, zero};
    for (std::size_t i = 0; i < lanes; i += row_length) {
        const Vector from{Row::load(before.x + i), Row::load(before.y + i), Row::load(before.z + i)};
        const Row F0 = Row::load(before.force + i);
        const Place place = surface.at(i, from);

        // Nodes at the surface go onto it.
        const Row way = where_above(zero, place.gap, place.gap, where_above(F0, zero, place.gap, zero));
        const Vector node{from.x - way * where_above(F0, zero, place.held.x, place.arriving.x),
                          from.y - way * where_above(F0, zero, place.held.y, place.arriving.y),
                          from.z - way * where_above(F0, zero, place.held.z, place.arriving.z)};

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
        const Row F = where_above(zero, place.gap, law, where_above(F0, zero, law, zero));
        const Row pressure = F * share;

        node.x.store(now.x + i);
        node.y.store(now.y + i);
        node.z.store(now.z + i);
        d.store(now.deflection + i);
        F.store(now.force + i);
        greater(d, Row::load(before.peak_deflection + i)).store(now.peak_deflection + i);
        where_above(line, envelope, d - envelope * compliance, residual).store(now.residual + i);
        place.gap.store(gaps + i);
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
