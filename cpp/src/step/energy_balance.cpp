#include "step/energy_balance.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/integrate.hpp"
#include "kernels/suspension.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

void note_departure(double size, const Scene& scene, const State& now, Balances::Departure& greatest) {
    if (size > greatest.size) greatest = {size, now.time, scene.base + now.units.front().body.position};
}

void check_energies(const Energies& e, const Scene& scene, const State& now, Balances& balances) {
    note_departure(std::abs(e.total() - balances.total), scene, now, balances.energy);
    balances.at_disposal = std::max(balances.at_disposal, balances.kinetic - e.potential);
    for (std::size_t i = 0; i < energy_terms.size(); ++i) {
        if (!energy_terms[i].is_loss) continue;
        const double value = e.*energy_terms[i].value;
        note_departure(balances.highest[i] - value, scene, now, balances.falls[i]);
        balances.highest[i] = std::max(balances.highest[i], value);
    }
}

// On the unit (N s).
Vec3 total_impulse(const ContactImpulses& sums) {
    Vec3 sum = sums.tire_friction + sums.joints;
    for (const double impulse : sums.tire)
        sum.z() += impulse;
    for (const ObstacleImpulse& one : sums.obstacles)
        sum += one.impulse;
    return sum;
}

// Change of each unit's momentum in the step, against the sum of all impulses that acted on it.
void check_momentum(const Scene& scene, const State& state, const Trial& trial, Balances& balances) {
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState &from = state.units[u], &to = trial.state.units[u];
        const double mass = scene.vehicle->units[u].body.mass;
        Vec3 impulse = total_impulse(trial.impulses[u]) + total_impulse(trial.at_start.impulses[u]) +
                       total_impulse(trial.at_end.impulses[u]);
        impulse.z() -= trial.dt * mass * scene.settings.gravity;
        for (const ContactLoad& contact : from.contact_loads)
            impulse += 0.5 * trial.dt * contact.history.now.wrench.force;
        for (const ContactLoad& contact : to.contact_loads)
            impulse += 0.5 * trial.dt * contact.history.now.wrench.force +
                       contact.higher_order.corrector.wrench.force;
        const Vec3 change = mass * (to.body.velocity - from.body.velocity);
        note_departure((change - impulse).norm(), scene, trial.state, balances.momentum);
        balances.largest_momentum =
            std::max({balances.largest_momentum, mass * to.body.velocity.norm(), impulse.norm()});
    }
}

}  // namespace

void sum_truss_energies(State& now) {
    now.energies.stored = 0.0;
    for (const UnitState& unit : now.units) {
        now.energies.stored += unit.skin.stored;
        now.truss_work += unit.skin.work;
    }
    now.energies.crushed = now.truss_work - now.energies.stored;
}

void sum_spring_energies(const Scene& scene, State& now) {
    if (!scene.settings.ground) return;
    now.energies.springs = 0.0;
    for (std::size_t u = 0; u < now.units.size(); ++u)
        now.energies.springs +=
            spring_energy(scene.vehicle->units[u], now.units[u].body, now.units[u].given_way);
}

void sum_kinetic_energy(const Scene& scene, State& now) {
    now.energies.kinetic = kinetic_energy_of(scene, now);
}

void check_balances(const Scene& scene, const State& state, const Trial& trial, Balances& balances) {
    if (!balances.begun) {
        balances.begun = true;
        balances.kinetic = balances.at_disposal = state.energies.kinetic;
        balances.total = state.energies.total();
        balances.largest_momentum = 0.0;
        for (std::size_t u = 0; u < state.units.size(); ++u)
            balances.largest_momentum =
                std::max(balances.largest_momentum,
                         scene.vehicle->units[u].body.mass * state.units[u].body.velocity.norm());
    }
    const State& now = trial.state;
    if (trial.at_start.happened) check_energies(trial.at_start.energies, scene, now, balances);
    if (trial.at_end.happened) check_energies(trial.at_end.energies, scene, now, balances);
    check_energies(now.energies, scene, now, balances);
    check_momentum(scene, state, trial, balances);
}

}  // namespace birm3d
