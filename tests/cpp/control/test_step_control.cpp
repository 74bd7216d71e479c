#include "control/step_control.hpp"

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::pi;

namespace {

StepStatistics statistics_of(Simulation simulation) {
    laboratory::run(simulation);
    return simulation.state().statistics;
}

// Nearest instant that a step of the run ended at (s).
double distance_to_a_step(Simulation simulation, double instant) {
    double nearest = laboratory::infinity;
    do
        nearest = std::min(nearest, std::abs(simulation.state().time - instant));
    while (simulation.step());
    return nearest;
}

}  // namespace

TEST("a step is as long as its error allows in flight, and short where wheels carry") {
    const auto vehicle = laboratory::block(laboratory::w2_curve(), 4, 4, laboratory::four_wheels(), 1.0);
    for (const double tolerance : {1e-2, 1e-3, 1e-5}) {
        Settings settings = laboratory::weightless(tolerance);
        const Approach straight{10.0, 0.5 * pi, 0.0, 0.0};
        const StepStatistics flight = statistics_of(Simulation({vehicle, nullptr, straight, settings, 1.0}));
        CHECK_CLOSE(flight.longest_step, 50e-3, 1e-12, "nothing hinders it");
        CHECK(flight.steps < 30);
        CHECK(flight.node_evaluations == 0);

        settings.gravity = 9.81;
        settings.ground = true;
        const StepStatistics road = statistics_of(Simulation({vehicle, nullptr, straight, settings, 1.0}));
        CHECK(road.longest_step <= 5e-3 * std::sqrt(std::min(1.0, tolerance / 1e-3)) * (1.0 + 1e-12));
    }
}

TEST("what turns takes shorter steps the faster it turns") {
    const auto vehicle = laboratory::block(laboratory::w2_curve(), 4, 4);
    double last = laboratory::infinity;
    for (const double spin : {1.0, 4.0, 16.0}) {
        Simulation simulation(
            {vehicle, nullptr, Approach{10.0, 0.5 * pi, 0.0, 0.0}, laboratory::weightless(1e-5), 0.5});
        Simulation::Snapshot start = simulation.snapshot();
        start.state.units[0].body.angular_momentum = {0.0, 0.0, 42000.0 * spin};
        simulation.restore(start);
        laboratory::run(simulation);
        const double longest = simulation.state().statistics.longest_step;
        // omega^4 dt^3 r / 12 stays below what is allowed, r^2 = trace(I) / 2 m.
        const double allowed = 0.01 * 1e-5 * 10.0, gyration = std::sqrt(0.5 * 87000.0 / 6804.0);
        CHECK(std::pow(spin, 4.0) * std::pow(longest, 3.0) * gyration / 12.0 <= allowed * (1.0 + 1e-9));
        CHECK(longest < last);
        last = longest;
    }
}

TEST("steps end where the approach turns into separation, and few are done again for it") {
    const double m = 6804.0, k = 3e6, v = 22.352;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        const Simulation simulation(laboratory::scene(laboratory::block(laboratory::w2_curve()),
                                                      laboratory::wall(), laboratory::weightless(tolerance)));
        // To the knee along k, and on from there along 2 k.
        const double omega = std::sqrt(k / m), knee = std::asin(0.4 * omega / v) / omega;
        const double left = v * std::cos(omega * knee), stiffer = omega * std::sqrt(2.0);
        const double turn = knee + std::atan2(left, 0.4 * k / m / stiffer) / stiffer;
        // The peak that is missed dt after it: F (1 - cos(w dt)) of the unloading slope, within the tolerance.
        const double unloading = std::sqrt(60e6 / m);
        CHECK(distance_to_a_step(simulation, turn) < std::sqrt(2.0 * tolerance) / unloading);
        const StepStatistics found = statistics_of(simulation);
        CHECK(found.rejected * 4 < found.steps);
    }
}

TEST("evaluations of rejected steps are counted") {
    const Simulation simulation(laboratory::scene(laboratory::block(laboratory::w2_curve(), 8, 8),
                                                  laboratory::wall(), laboratory::weightless(1e-4)));
    const StepStatistics found = statistics_of(simulation);
    CHECK(found.rejected > 0);
    CHECK(found.node_evaluations <= (found.steps + found.rejected) * 64);
    const std::uint64_t in_touch = found.steps - found.free_steps;
    CHECK(found.node_evaluations > in_touch * 64);
}
