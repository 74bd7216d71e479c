#include "scene/obstacles.hpp"

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

TEST("the nearest gap is that of the nearest node, crushed or not") {
    // 200 nodes: blocks that are looked at and blocks that can be left out.
    const auto vehicle = laboratory::block(laboratory::w2_curve(), 20, 10);
    for (const double angle : {0.5 * laboratory::pi, 1.0, 0.2}) {
        Simulation simulation(
            laboratory::scene(vehicle, laboratory::wall(), laboratory::weightless(), angle, 0.1));
        for (int steps = 0; simulation.step(); ++steps) {
            const State& state = simulation.state();
            const UnitState& unit = state.units[0];
            const Mat3 R = unit.body.orientation.toRotationMatrix();
            double nearest = laboratory::infinity;
            for (const TrussBlockState& block : unit.trusses.block)
                for (std::size_t i = 0; i < block_size; ++i) {
                    const Vec3 place = unit.body.position + R * Vec3(block.x[i], block.y[i], block.z[i]);
                    nearest = std::min(nearest, laboratory::gap_to_barrier(simulation.scene(), place));
                }
            CHECK_CLOSE(nearest_gap(simulation.scene(), state, {}), nearest, 1e-13, "rounding of places");
        }
    }
}
