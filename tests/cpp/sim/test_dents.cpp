#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

std::shared_ptr<const Vehicle> dented(double slope, int columns, int rows) {
    TrussInput input = laboratory::front_face(laboratory::w2_curve(), columns, rows);
    input.dent_slope = slope;
    Vehicle vehicle;
    vehicle.units.emplace_back(laboratory::body(), input, std::vector<Wheel>{}, 0.0);
    return std::make_shared<const Vehicle>(std::move(vehicle));
}

Simulation crash(const std::shared_ptr<const Vehicle>& vehicle, const Barrier& barrier, double friction_free,
                 double tolerance = 1e-3) {
    const auto shared = std::make_shared<const Barrier>(barrier);
    Simulation simulation(Scene(vehicle, shared, Approach{friction_free, 0.5 * laboratory::pi, 0.1, 0.0},
                                laboratory::weightless(tolerance), 0.4));
    laboratory::run(simulation);
    return simulation;
}

double deepest(const Simulation& simulation) {
    double most = 0.0;
    for (const TrussBlockState& block : simulation.state().units[0].trusses.block)
        for (const double d : block.peak_deflection)
            most = std::max(most, d);
    return most;
}

}  // namespace

TEST("at a wall nothing hangs on anything: the same bits with and without dents") {
    const Barrier wall = Barrier::wall(0.2, Vec3::Zero(), 0.0);
    CHECK(crash(dented(0.0, 20, 12), wall, 10.0).state().hash() ==
          crash(dented(1.0, 20, 12), wall, 10.0).state().hash());
}

TEST("the ledger closes with dents, with and without friction, and better with smaller steps") {
    for (const double friction : {0.0, 0.3}) {
        const Barrier pole = Barrier::pole(friction, Vec3(0.0, 0.2, 0.0), 0.0, 0.15);
        double last = 1.0;
        for (const double tolerance : {1e-2, 1e-4}) {
            Simulation simulation = crash(dented(1.0, 24, 16), pole, 6.0, tolerance);
            const double start = 0.5 * 6804.0 * 36.0;
            const double residual = std::abs(simulation.state().energies.total() / start - 1.0);
            CHECK(residual < std::max(1e-3, 0.3 * tolerance));
            CHECK(residual < last);
            last = residual;
        }
    }
}

TEST("a dent makes a pole's force independent of the mesh, and greater") {
    const Barrier pole = Barrier::pole(0.0, Vec3::Zero(), 0.0, 0.15);
    const double alone = deepest(crash(dented(0.0, 48, 32), pole, 5.0));
    const double coarse = deepest(crash(dented(1.0, 24, 16), pole, 5.0));
    const double fine = deepest(crash(dented(1.0, 48, 32), pole, 5.0));
    CHECK(fine < 0.8 * alone);
    // Nodes 0.1 m apart on a pole of 0.3 m: three of them or four are pressed.
    CHECK_CLOSE(coarse, fine, 0.05 * fine, "the mesh's resolution of the pole");
}
