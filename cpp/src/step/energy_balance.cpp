#include "birm3d/step/energy_balance.hpp"

#include <algorithm>
#include <cmath>

namespace birm3d {

namespace {

void note(double size, const Scene& scene, const State& now, Ledger::Departure& greatest) {
    if (size > greatest.size) greatest = {size, now.time, scene.base + now.units.front().body.position};
}

void check_energies(const Energies& e, const Scene& scene, const State& now, Ledger& ledger) {
    note(std::abs(e.total() - ledger.total), scene, now, ledger.energy);
    ledger.at_disposal = std::max(ledger.at_disposal, ledger.kinetic - e.potential);
    const std::array<double, Ledger::terms> terms{e.crushed,         e.barrier_friction, e.tire_friction,
                                                  e.ground_friction, e.impacts,          e.segment_friction};
    for (std::size_t i = 0; i < terms.size(); ++i) {
        note(ledger.highest[i] - terms[i], scene, now, ledger.falls[i]);
        ledger.highest[i] = std::max(ledger.highest[i], terms[i]);
    }
}

Vec3 total(const ContactImpulses& sums) {
    Vec3 sum = sums.tire_friction + sums.joints;
    for (const double impulse : sums.tire)
        sum.z() += impulse;
    for (const ObstacleImpulse& of : sums.obstacles)
        sum += of.impulse;
    return sum;
}

void check_momentum(const Scene& scene, const State& state, const Trial& trial, Ledger& ledger) {
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState &from = state.units[u], &to = trial.state.units[u];
        const double mass = scene.vehicle->units[u].body.mass;
        Vec3 impulse =
            total(trial.impulses[u]) + total(trial.at_start.impulses[u]) + total(trial.at_end.impulses[u]);
        impulse.z() -= trial.dt * mass * scene.settings.gravity;
        for (const Touch& touch : from.touches)
            impulse += 0.5 * trial.dt * touch.course.now.wrench.force;
        for (const Touch& touch : to.touches)
            impulse += 0.5 * trial.dt * touch.course.now.wrench.force + touch.extra.correction.wrench.force;
        const Vec3 change = mass * (to.body.velocity - from.body.velocity);
        note((change - impulse).norm(), scene, trial.state, ledger.momentum);
        ledger.largest_momentum =
            std::max({ledger.largest_momentum, mass * to.body.velocity.norm(), impulse.norm()});
    }
}

}  // namespace

void check_ledger(const Scene& scene, const State& state, const Trial& trial, Ledger& ledger) {
    if (!ledger.begun) {
        ledger.begun = true;
        ledger.kinetic = ledger.at_disposal = state.energies.kinetic;
        ledger.total = state.energies.total();
        ledger.largest_momentum = 0.0;
        for (std::size_t u = 0; u < state.units.size(); ++u)
            ledger.largest_momentum =
                std::max(ledger.largest_momentum,
                         scene.vehicle->units[u].body.mass * state.units[u].body.velocity.norm());
    }
    const State& now = trial.state;
    if (trial.at_start.happened) check_energies(trial.at_start.energies, scene, now, ledger);
    if (trial.at_end.happened) check_energies(trial.at_end.energies, scene, now, ledger);
    check_energies(now.energies, scene, now, ledger);
    check_momentum(scene, state, trial, ledger);
}

}  // namespace birm3d
