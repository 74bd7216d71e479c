#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

std::shared_ptr<const Vehicle> indented(double reach, int columns, int rows) {
    TrussInput input = laboratory::front_face(laboratory::w2_curve(), columns, rows);
    input.indentation_length = reach;
    Vehicle vehicle;
    vehicle.units.emplace_back(laboratory::body(), input, std::vector<Wheel>{}, 0.0);
    return std::make_shared<const Vehicle>(std::move(vehicle));
}

Simulation crash(const std::shared_ptr<const Vehicle>& vehicle, const Barrier& barrier, double speed,
                 double tolerance = 1e-3, double degrees = 90.0) {
    const auto shared = std::make_shared<const Barrier>(barrier);
    Simulation simulation(Scene(vehicle, shared, Approach{speed, degrees / 180.0 * laboratory::pi, 0.1, 0.0},
                                laboratory::weightless(tolerance), 0.4));
    laboratory::run(simulation);
    return simulation;
}

}  // namespace

TEST("a wall makes no indentation: the same bits with and without") {
    const Barrier wall = Barrier::wall(0.2, Vec3::Zero(), 0.0);
    CHECK(crash(indented(0.0, 20, 12), wall, 10.0).state().hash() ==
          crash(indented(0.65, 20, 12), wall, 10.0).state().hash());
}

TEST("the balance closes with indentations, with and without friction, and better with smaller steps") {
    for (const double degrees : {90.0, 60.0})
        for (const double friction : {0.0, 0.3}) {
            const Barrier pole = Barrier::pole(friction, Vec3(0.0, 0.2, 0.0), 0.0, 0.15);
            double last = 1.0;
            for (const double tolerance : {1e-2, 1e-4}) {
                Simulation simulation = crash(indented(0.65, 24, 16), pole, 6.0, tolerance, degrees);
                const double start = 0.5 * 6804.0 * 36.0;
                const double residual = std::abs(simulation.state().energies.total() / start - 1.0);
                CHECK(residual < std::max(1e-4, 0.1 * tolerance));
                CHECK(residual < last);
                last = residual;
            }
        }
}

TEST("an indentation makes a pole's force independent of the mesh, and greater") {
    const Barrier pole = Barrier::pole(0.0, Vec3::Zero(), 0.0, 0.15);
    const double coarse = laboratory::deepest(crash(indented(0.65, 24, 16), pole, 5.0));
    const double fine = laboratory::deepest(crash(indented(0.65, 48, 32), pole, 5.0));
    // Nodes 0.1 m apart on a pole of 0.3 m: three of them or four are pressed.
    CHECK_CLOSE(coarse, fine, 0.005 * fine, "the mesh's resolution of the pole");
    // What the trusses take while the pole comes 0.2 m in: alone they slip round it to either side.
    const auto work = [&](double reach) {
        const auto shared = std::make_shared<const Barrier>(pole);
        Simulation simulation(Scene(indented(reach, 48, 32), shared,
                                    Approach{5.0, 0.5 * laboratory::pi, 0.1, 0.0}, laboratory::weightless(),
                                    0.4));
        const double start = simulation.state().units[0].body.position.x();
        while (simulation.state().units[0].body.position.x() < start + 0.2 && simulation.step()) {
        }
        return simulation.state().truss_work;
    };
    CHECK(work(0.65) > 2.0 * work(0.0));
}

TEST("a post that is as wide as the front presses it as a wall does") {
    const Barrier pole = Barrier::pole(0.0, Vec3::Zero(), 0.0, 1e5);
    const double by_pole = laboratory::deepest(crash(indented(0.65, 24, 16), pole, 5.0));
    const double by_wall =
        laboratory::deepest(crash(indented(0.65, 24, 16), Barrier::wall(0.0, Vec3::Zero(), 0.0), 5.0));
    CHECK_CLOSE(by_pole, by_wall, 1e-4 * by_wall, "the post's curvature: 1.2^2 / 2e5 m");
}

TEST("a post that comes from the side indents no front") {
    // The vehicle goes along y, across its own axis, by way of the yaw; the post stands 0.5 m behind the front.
    const auto vehicle = indented(0.65, 24, 16);
    const auto pole = std::make_shared<const Barrier>(Barrier::pole(0.0, Vec3::Zero(), 0.0, 0.15));
    Approach approach{6.0, 0.5 * laboratory::pi, -2.5, 0.05};
    approach.yaw = 0.5 * laboratory::pi;
    Simulation simulation(Scene(vehicle, pole, approach, laboratory::weightless(), 0.4));
    laboratory::run(simulation);
    CHECK(laboratory::deepest(simulation) < 0.02);
}
