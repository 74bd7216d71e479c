#include "birm3d/sim/step.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/kernels/integrate.hpp"
#include "birm3d/sim/barrier_forces.hpp"
#include "birm3d/sim/half_kick.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Smooth accelerations of the unit, for the error estimate.
void set_accelerations(const Unit& unit, UnitState& now) {
    Wrench sum = now.skin.contact;
    sum += now.skin.friction;
    now.acceleration = unit.body.inverse_mass * sum.force;
    now.angular_acceleration = inverse_inertia_in_world(unit.body, now.body) * sum.torque;
}

double velocity_error(const Unit& unit, const UnitState& before, UnitState& now, double dt) {
    // Leapfrog integrates a force that is linear in time exactly: the departure from a straight line over
    // the step bounds the error. An eighth of it covers a slope that changes anywhere within the step.
    const Vec3 departure = now.acceleration - (before.acceleration + dt * before.jerk);
    const Vec3 angular_departure =
        now.angular_acceleration - (before.angular_acceleration + dt * before.angular_jerk);
    now.jerk = (now.acceleration - before.acceleration) / dt;
    now.angular_jerk = (now.angular_acceleration - before.angular_acceleration) / dt;
    const double gyration = std::sqrt(0.5 * unit.body.inertia.trace() * unit.body.inverse_mass);
    return dt / 8.0 * (departure.norm() + gyration * angular_departure.norm());
}

// 2/omega of the trusses in contact, infinite without any.
double critical_step(const SkinForces& skin) {
    return skin.stiffness > 0.0 ? 2.0 / std::sqrt(skin.stiffness) : infinity;
}

void clear(ContactImpulses& impulses) {
    std::fill(impulses.tire.begin(), impulses.tire.end(), 0.0);
    impulses.tire_friction = impulses.barrier = Vec3::Zero();
    impulses.barrier_normal = 0.0;
}

void begin(const State& from, double dt, Trial& trial) {
    static_cast<Progress&>(trial.state) = from;
    trial.state.time += dt;
    trial.dt = dt;
    trial.error = 0.0;
    trial.critical_step = trial.impact_after = trial.nearest_gap = infinity;
    trial.at_start.happened = trial.at_end.happened = false;
    for (std::size_t u = 0; u < from.units.size(); ++u) {
        static_cast<UnitMotion&>(trial.state.units[u]) = from.units[u];
        trial.active[u].clear();
        clear(trial.impulses[u]);
        clear(trial.at_start.impulses[u]);
        clear(trial.at_end.impulses[u]);
    }
}

void book_trusses(State& now) {
    now.energies.stored = 0.0;
    for (const UnitState& unit : now.units) {
        now.energies.stored += unit.skin.stored;
        now.truss_work += unit.skin.work;
    }
    now.energies.crushed = now.truss_work - now.energies.stored;
}

void book_motion(const Scene& scene, State& now) {
    now.energies.kinetic = 0.0;
    for (std::size_t u = 0; u < now.units.size(); ++u)
        now.energies.kinetic += kinetic_energy(scene.vehicle->units[u].body, now.units[u].body);
}

}  // namespace

Trial::Trial(const Vehicle& vehicle) : state(vehicle), active(vehicle.units.size()) {
    for (const Unit& unit : vehicle.units)
        impulses.emplace_back(unit.wheels.size());
    at_start.impulses = at_end.impulses = impulses;
}

bool Trial::body_held() const {
    const auto held = [](const ContactImpulses& sum) { return sum.barrier_normal > 0.0; };
    return std::any_of(impulses.begin(), impulses.end(), held) ||
           std::any_of(at_start.impulses.begin(), at_start.impulses.end(), held) ||
           std::any_of(at_end.impulses.begin(), at_end.impulses.end(), held);
}

void try_step(const Scene& scene, const State& from, double dt, const StepOptions& options, Trial& trial) {
    State& now = trial.state;
    begin(from, dt, trial);
    half_kick(scene, Stage::before_drift, options, trial);

    for (std::size_t u = 0; u < now.units.size(); ++u) {
        const Unit& unit = scene.vehicle->units[u];
        UnitState& moved = now.units[u];
        now.energies.potential += dt * unit.body.mass * scene.settings.gravity * moved.body.velocity.z();
        drift(unit.body, dt, moved.body);

        if (scene.barrier) barrier_forces(scene, u, from, trial);
        if (moved.skin.normal_force > 0.0) now.touched = true;

        set_accelerations(unit, moved);
        trial.error = std::max(trial.error, velocity_error(unit, from.units[u], moved, dt));
        trial.critical_step = std::min(trial.critical_step, critical_step(moved.skin));
    }

    book_trusses(now);

    half_kick(scene, Stage::after_drift, options, trial);
    book_motion(scene, now);
}

void accept(const Trial& trial, State& state) {
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        UnitState& to = state.units[u];
        const UnitState& with = trial.state.units[u];
        static_cast<UnitMotion&>(to) = with;
        for (const std::size_t block : trial.active[u])
            to.trusses.block[block] = with.trusses.block[block];
    }
    static_cast<Progress&>(state) = trial.state;
    StepStatistics& statistics = state.statistics;
    statistics.steps += 1;
    statistics.shortest_step = std::min(statistics.shortest_step, trial.dt);
    statistics.longest_step = std::max(statistics.longest_step, trial.dt);
    statistics.least_critical_step = std::min(statistics.least_critical_step, trial.critical_step);
}

}  // namespace birm3d
