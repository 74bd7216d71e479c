#include "step/step.hpp"

#include <algorithm>

#include "contact/contact_forces.hpp"
#include "kernels/integrate.hpp"
#include "kernels/steering.hpp"
#include "kernels/suspension.hpp"
#include "kernels/tires.hpp"
#include "scene/bodies.hpp"
#include "step/energy_balance.hpp"
#include "step/error_estimates.hpp"
#include "step/half_kick.hpp"
#include "step/load_history.hpp"
#include "step/step_statistics.hpp"

namespace birm3d {

namespace {

// The trial becomes a copy of the start; the histories of its loads predict their impulses over the step.
void begin(const State& from, double dt, Trial& trial) {
    trial.begin(from, dt);
    for (UnitState& unit : trial.state.units)
        for (ContactLoad& contact : unit.contact_loads)
            contact.higher_order = {predictor(contact.history, dt), {}};
}

void note_drift_velocities(Trial& trial) {
    trial.drift_velocity_z.clear();
    for (const UnitState& unit : trial.state.units)
        trial.drift_velocity_z.push_back(unit.body.velocity.z());
}

// Drift, then detection (5.1), crush (5.3) and friction (5.4) at the end of the step.
void move_unit(const Scene& scene, std::size_t u, const State& from, Trial& trial) {
    const Unit& unit = scene.vehicle->units[u];
    State& now = trial.state;
    UnitState& moved = now.units[u];
    now.energies.potential += trial.dt * unit.body.mass * scene.settings.gravity * moved.body.velocity.z();
    // Steering by the mean of the travel angles before and after the drift, at the velocity of the middle of the step.
    const auto steer = [&](double dt) {
        const Twist motion{moved.body.velocity, angular_velocity(unit.body, moved.body)};
        moved.steering_angle =
            steered(unit, moved.body.orientation, motion, moved.steering_angle, dt, trial.impulses[u].tire);
    };
    const bool does_steer = steers(unit);
    if (does_steer) steer(0.5 * trial.dt);
    drift(unit.body, trial.dt, moved.body);
    if (does_steer) steer(0.5 * trial.dt);
    if (!scene.obstacles.empty()) find_contact_forces(scene, u, from, trial);
    if (skin_touches_barrier(scene, moved)) now.touched = true;
    trial.error = std::max(trial.error, correct_loads(scene, u, from.units[u], trial));
    trial.critical_step = std::min(trial.critical_step, critical_step(scene, unit.body, moved));
}

// Updates the loads by which the wheels of a unit give way: by the impulses of the whole step, impacts included.
void follow_wheel_loads(const Trial& trial, std::size_t u, UnitMotion& unit) {
    Column sum = trial.impulses[u].tire;
    for (const Impact* impact : {&trial.at_start, &trial.at_end})
        if (impact->happened)
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += impact->impulses[u].tire[i];
    unit.wheel_loads.resize(sum.size());
    follow_loads(trial.dt, sum, unit.wheel_loads);
}

// Wheels whose springs give way carry nothing any more. What their springs had stored is lost.
void give_way(const Unit& model, UnitMotion& unit, Energies& energies) {
    const WheelSet gone = overloaded(model, unit.wheel_loads);
    if ((gone & ~unit.given_way) == 0) return;
    const double before = spring_energy(model, unit.body, unit.given_way);
    unit.given_way |= gone;
    const double lost = before - spring_energy(model, unit.body, unit.given_way);
    energies.springs -= lost;
    energies.dampers += lost;
}

}  // namespace

void try_step(const Scene& scene, const State& from, double dt, const StepOptions& options, Trial& trial) {
    State& now = trial.state;
    begin(from, dt, trial);

    // Rigid contacts (5.2) and half of the forces at the start.
    half_kick(scene, Stage::before_drift, options, trial);
    if (trial.impact_within()) return;
    note_drift_velocities(trial);

    // Moving elements before units: units see where these are at the end of the step.
    for (std::size_t i = 0; i < now.moving_elements.size(); ++i)
        drift(scene.barrier->moving_elements[i].body, dt, now.moving_elements[i]);
    for (std::size_t u = 0; u < now.units.size(); ++u)
        move_unit(scene, u, from, trial);
    sum_truss_energies(now);
    sum_spring_energies(scene, now);
    trial.error = std::max({trial.error, joint_error(scene, now, dt), rotation_error(scene, now, dt)});

    // Rigid contacts again, and half of the forces at the end.
    half_kick(scene, Stage::after_drift, options, trial);
    trial.error = std::max(trial.error, weight_error(scene, from, trial));
    sum_kinetic_energy(scene, now);
    // A post that stands between nodes meets only the rigid body.
    if (trial.body_held_by_barrier()) now.touched = true;
}

void accept(const Scene& scene, Trial& trial, State& state) {
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        UnitState& unit = state.units[u];
        static_cast<UnitMotion&>(unit) = trial.state.units[u];
        const Unit& model = scene.vehicle->units[u];
        if (may_give_way(model)) {
            follow_wheel_loads(trial, u, unit);
            give_way(model, unit, trial.state.energies);
        }
        trial.exchange_trusses(u, unit.trusses);
        const std::vector<std::size_t>& active = trial.active[u].blocks();
        if (!active.empty()) unit.trusses.group(model.trusses, active);
    }
    static_cast<Progress&>(state) = trial.state;
    state.moving_elements = trial.state.moving_elements;
    count_step(scene, trial, state);
}

}  // namespace birm3d
