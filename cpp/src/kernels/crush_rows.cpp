// Compiled once for each instruction set; see base/row.hpp for what that forbids.
#include "kernels/crush_rows.hpp"
#include "base/row.hpp"
#include "birm3d/base/lane_count.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

BIRM3D_INLINE void add_to(double* sum, const Row& row) {
    (Row::load(sum) + row).store(sum);
}

}  // namespace

double press_flat(const PressColumns& truss, const FlatSurface& surface,
                  const PressState<const double>& before, const PressState<double>& now, double* gaps,
                  double* pressures, NodeSums& sums);

double press_flat(const PressColumns& truss, const FlatSurface& surface,
                  const PressState<const double>& before, const PressState<double>& now, double* gaps,
                  double* pressures, NodeSums& sums) {
    const Row zero = Row::of(0.0), one = Row::of(1.0), least = Row::of(tolerance::truss_length);
    const Row nx = Row::of(surface.nx), ny = Row::of(surface.ny), nz = Row::of(surface.nz);
    const Row hx = Row::of(surface.hx), hy = Row::of(surface.hy), hz = Row::of(surface.hz);
    const Row offset = Row::of(surface.offset), node_left = Row::of(left);
    Row force = zero, force_x = zero, force_y = zero, force_z = zero, work = zero, stored = zero,
        nodes = zero;
    for (std::size_t i = 0; i < lanes; i += row_length) {
        const Row x0 = Row::load(before.x + i), y0 = Row::load(before.y + i), z0 = Row::load(before.z + i);
        const Row F0 = Row::load(before.force + i), dp = Row::load(before.peak_deflection + i);

        // Nodes at the surface go onto it: along n where they arrive, along h where it held them already.
        const Row gap = nx * x0 + ny * y0 + nz * z0 - offset;
        const Row way = where_above(zero, gap, gap, where_above(F0, zero, gap, zero));
        const Row x = x0 - way * where_above(F0, zero, hx, nx);
        const Row y = y0 - way * where_above(F0, zero, hy, ny);
        const Row z = z0 - way * where_above(F0, zero, hz, nz);

        // B = node - anchor. A closed truss has no direction of its own any more: it presses along n.
        const Row bx = Row::load(truss.anchor_x + i) - x, by = Row::load(truss.anchor_y + i) - y,
                  bz = Row::load(truss.anchor_z + i) - z;
        const Row length = square_root(bx * bx + by * by + bz * bz);
        const Row facing = bx * nx + by * ny + bz * nz;
        const Row share = where_above(length, least, greater(facing, zero) / length, one);
        const Row d = Row::load(truss.length + i) - length;

        // Fig. 3: the loading envelope by the changes of slope at its hinges, or the unloading line.
        Row envelope = zero;
        for (std::size_t j = 0; j < truss.hinges; ++j) {
            const double* hinge = truss.hinge + j * 2 * lanes + i;
            envelope = envelope + Row::load(hinge + lanes) * greater(d - Row::load(hinge), zero);
        }
        const Row Fp = Row::load(before.peak_force + i);
        const Row line = greater(Fp - Row::load(truss.k_unloading + i) * (dp - d), zero);
        const Row law = where_above(d, dp, envelope, line);
        const Row F = where_above(zero, gap, law, where_above(F0, zero, law, zero));
        const Row pressure = F * share;

        x.store(now.x + i);
        y.store(now.y + i);
        z.store(now.z + i);
        d.store(now.deflection + i);
        F.store(now.force + i);
        greater(d, dp).store(now.peak_deflection + i);
        where_above(d, dp, envelope, Fp).store(now.peak_force + i);
        gap.store(gaps + i);
        pressure.store(pressures + i);

        force = force + pressure;
        force_x = force_x + pressure * x;
        force_y = force_y + pressure * y;
        force_z = force_z + pressure * z;
        work = work + (F0 + F) * (d - Row::load(before.deflection + i));
        stored = stored + F * F * Row::load(truss.compliance + i);
        nodes = nodes + where_above(F, zero, one, where_above(F0, zero, node_left, zero));
    }
    add_to(sums.force, force);
    add_to(sums.force_x, force_x);
    add_to(sums.force_y, force_y);
    add_to(sums.force_z, force_z);
    add_to(sums.twice_work, work);
    add_to(sums.twice_stored, stored);
    return sum_of(nodes);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
