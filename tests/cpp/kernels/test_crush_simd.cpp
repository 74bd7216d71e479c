#include "check.hpp"
#include "kernels/crush_columns.hpp"
#include "kernels/random_columns.hpp"
#include "kernels/simd_table.hpp"
#include "laboratory.hpp"
#include "state/block_contact.hpp"

using namespace birm3d;

namespace {

struct Pressed {
    TrussBlockState now;
    BlockContact contact;
    NodeSums sums;
    PressedNodes nodes;
};

bool same(const Pressed& a, const Pressed& b) {
    return same_bits(a.now.x, b.now.x) && same_bits(a.now.y, b.now.y) && same_bits(a.now.z, b.now.z) &&
           same_bits(a.now.deflection, b.now.deflection) && same_bits(a.now.force, b.now.force) &&
           same_bits(a.now.peak_deflection, b.now.peak_deflection) &&
           same_bits(a.now.residual, b.now.residual) &&
           same_bits(a.contact.normal_force, b.contact.normal_force) &&
           same_bits(a.contact.px, b.contact.px) && same_bits(a.contact.tx, b.contact.tx) &&
           same_bits(a.contact.tz, b.contact.tz) && same_bits(a.sums, b.sums) &&
           a.nodes.pushing == b.nodes.pushing && a.nodes.ceased == b.nodes.ceased;
}

}  // namespace

TEST("every instruction set gives the same bits") {
    laboratory::Random random(1);
    TrussCurve giving = laboratory::w2_curve();
    giving.recovery = 0.05;
    const std::vector<SimdPath> functions = simd_paths();
    for (int round = 0; round < 100; ++round) {
        const bool recovers = round >= 50;
        const TrussMesh mesh(laboratory::front_face(recovers ? giving : laboratory::w2_curve(), 8, 8));
        // Nodes all about a slanted surface, some pressed already, on their envelopes or below.
        TrussBlockState before = TrussState(mesh).block[0];
        alignas(64) BlockColumn factor, gap, nx, ny, nz, bx, by, bz;
        fill(random, before.x, 2.7, 0.3);
        fill(random, before.deflection, 0.3, 0.3);
        fill(random, before.force, 0.0, 1e4);
        for (double& force : before.force)
            force = std::max(force, 0.0);
        fill(random, before.residual, 0.25, 0.3);
        fill(random, before.peak_deflection, 0.6, 0.3);
        if (recovers) fill(random, before.unloading, 1e6, 5e5);
        fill(random, factor, 1.2, 0.2);
        fill(random, gap, 0.0, 0.05);
        fill(random, nx, -0.9, 0.1);
        fill(random, ny, 0.0, 0.4);
        fill(random, nz, 0.0, 0.4);
        fill(random, bx, -0.9, 0.1);
        fill(random, by, 0.0, 0.4);
        fill(random, bz, 0.0, 0.4);
        for (std::size_t i = 0; i < 8; ++i)  // a row of nodes that are free
            before.force[i] = 0.0, gap[i] = std::abs(gap[i]);
        const bool changed = round % 2 == 1;
        const PressColumns columns = columns_of(mesh, 0, changed ? &factor : nullptr);
        const FlatPress flat{-0.96, 0.28, 0.0, -2.6, -0.95, 0.3, 0.01};
        alignas(64) BlockColumn drawn, place, torque;  // half of the nodes hang in an indentation
        fill(random, drawn, 0.0, 1.0);
        fill(random, place, 2.7, 0.3);
        fill(random, torque, 0.0, 3.0);
        Pressed first_flat, first_curved;
        for (std::size_t k = 0; k < functions.size(); ++k) {
            alignas(64) BlockColumn gaps;
            Pressed by_flat, by_curved;
            BlockContact& at = by_curved.contact;
            at.px = at.py = at.pz = place, at.tx = at.ty = at.tz = torque;
            const CurvedPress curved{gap.data(),   nx.data(),    ny.data(),    nz.data(),    bx.data(),
                                     by.data(),    bz.data(),    drawn.data(), at.px.data(), at.py.data(),
                                     at.pz.data(), at.tx.data(), at.ty.data(), at.tz.data(), 1e-4,
                                     2e-5,         3e-5,         3e-5,         1e-6,         2e-6,
                                     3e-6};
            by_flat.nodes = functions[k].press_flat(columns, flat, columns_of<const double>(before),
                                                    columns_of<double>(by_flat.now), gaps.data(),
                                                    by_flat.contact.normal_force.data(), by_flat.sums);
            by_curved.nodes = functions[k].press_curved(
                columns, curved, columns_of<const double>(before), columns_of<double>(by_curved.now),
                gaps.data(), by_curved.contact.normal_force.data(), by_curved.sums);
            if (k == 0) {
                first_flat = by_flat;
                first_curved = by_curved;
                CHECK(by_flat.nodes.pushing > 1.0);
                CHECK(by_curved.nodes.pushing > 1.0);
            }
            CHECK(same(by_flat, first_flat));
            CHECK(same(by_curved, first_curved));
            for (std::size_t i = 0; i < 8; ++i)
                CHECK(by_curved.now.x[i] == before.x[i] && by_curved.now.residual[i] == before.residual[i] &&
                      by_curved.contact.normal_force[i] == 0.0 && by_curved.contact.tx[i] == 0.0);
        }
    }
}
