#include "birm3d/record/recorder.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/rotation.hpp"
#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::pi;

namespace {

Simulation crash(double output_interval) {
    Settings settings;
    settings.output_interval = output_interval;
    Simulation simulation(
        Scene(laboratory::block(laboratory::w2_curve(), 10, 10, laboratory::four_wheels(), 1.0),
              laboratory::wall(0.2), Approach{15.0, 40.0 * pi / 180.0, 0.0, 0.1}, settings, 0.25));
    laboratory::run(simulation);
    return simulation;
}

}  // namespace

TEST("forces integrate to the change of momentum, row by row, at any output interval") {
    for (const double interval : {1e-4, 1e-3, 7.3e-3}) {
        const Simulation simulation = crash(interval);
        const History history = simulation.recorder().resample(simulation.scene());
        const UnitHistory& unit = history.units[0];
        const double m = 6804.0;
        double worst = 0.0, largest = 0.0;
        for (std::size_t k = 1; k < history.time.size(); ++k) {
            Vec3 force = unit.barrier_force[k] + unit.tire_friction_force[k] - Vec3(0.0, 0.0, m * 9.80665);
            for (const Column& wheel : unit.tire_reaction)
                force.z() += wheel[k];
            const double dt = history.time[k] - history.time[k - 1];
            worst = std::max(worst, (m * (unit.velocity[k] - unit.velocity[k - 1]) - dt * force).norm() / dt);
            largest = std::max(largest, force.norm());
        }
        CHECK(largest > 1e5);
        CHECK_CLOSE(worst / largest, 0.0, 1e-9, "rounding of velocities, over the interval");
        CHECK_CLOSE(history.momentum_residual, 0.0, 1e-9, "the same");
    }
}

TEST("rows stand at multiples of the interval, and the first and the last are the state's own") {
    const Simulation simulation = crash(1e-3);
    const Scene& scene = simulation.scene();
    const History history = simulation.recorder().resample(scene);
    const UnitHistory& unit = history.units[0];
    CHECK(history.time.size() == 251);
    for (std::size_t k = 0; k < history.time.size(); ++k)
        CHECK_CLOSE(history.time[k], 1e-3 * static_cast<double>(k), 1e-15, "rounding");
    const BodyState start = scene.initial_state().units[0].body, end = simulation.state().units[0].body;
    CHECK(unit.position.front() == start.position);
    CHECK(unit.velocity.front() == start.velocity);
    CHECK_CLOSE((unit.position.back() - end.position).norm(), 0.0, 1e-8,
                "the last step ends within 1e-9 s of the last row");
    CHECK_CLOSE((unit.velocity.back() - end.velocity).norm(), 0.0, 1e-8, "the same");
    CHECK_CLOSE(unit.orientation.back().angularDistance(end.orientation), 0.0, 1e-6,
                "an angle from a cosine");
}

TEST("what a coarse history shows is the mean of what a fine one shows") {
    const Simulation fine = crash(1e-4), coarse = crash(1e-3);
    CHECK(fine.state().hash() == coarse.state().hash());
    const UnitHistory a = fine.recorder().resample(fine.scene()).units[0];
    const UnitHistory b = coarse.recorder().resample(coarse.scene()).units[0];
    for (std::size_t k = 1; k < b.position.size(); ++k) {
        Vec3 mean = Vec3::Zero();
        double normal = 0.0;
        for (std::size_t i = 10 * (k - 1) + 1; i <= 10 * k; ++i) {
            mean += 0.1 * a.barrier_force[i];
            normal += 0.1 * a.barrier_normal_force[i];
        }
        CHECK_CLOSE((mean - b.barrier_force[k]).norm(), 0.0, 1e-3,
                    "rounding of impulses since the start, over 0.1 ms");
        CHECK_CLOSE(normal, b.barrier_normal_force[k], 1e-3, "the same");
        CHECK_CLOSE((a.velocity[10 * k] - b.velocity[k]).norm(), 0.0, 1e-12, "rounding");
        CHECK_CLOSE((a.position[10 * k] - b.position[k]).norm(), 0.0, 1e-12, "rounding");
    }
}

TEST("the energy residual is the greatest of all rows") {
    for (const double interval : {1e-4, 7.3e-3}) {
        const Simulation simulation = crash(interval);
        const History history = simulation.recorder().resample(simulation.scene());
        const auto total = [&history](std::size_t k) {
            double sum = 0.0;
            for (const Column& column : history.energies)
                sum += column[k];
            return sum;
        };
        double greatest = 0.0;
        for (std::size_t k = 0; k < history.time.size(); ++k)
            greatest = std::max(greatest, std::abs(total(k) - total(0)));
        CHECK(history.kinetic_at_start == history.energy(&Energies::kinetic)[0]);
        CHECK(greatest > 0.0);
        CHECK_CLOSE(history.energy_residual, greatest, 1e-14 * history.energy(&Energies::kinetic)[0],
                    "rounding of the sums");
    }
}

TEST("a run of no steps has one row") {
    const Simulation simulation(laboratory::scene(laboratory::block(laboratory::w2_curve()),
                                                  laboratory::wall(), laboratory::weightless()));
    const History history = simulation.recorder().resample(simulation.scene());
    CHECK(history.time.size() == 1);
    CHECK_CLOSE(history.energy(&Energies::kinetic)[0], 0.5 * 6804.0 * 22.352 * 22.352, 1e-6, "rounding");
    CHECK(history.kinetic_at_start == history.energy(&Energies::kinetic)[0]);
    CHECK(history.energy_residual == 0.0);
    CHECK(history.units[0].barrier_force[0] == Vec3::Zero());
}
