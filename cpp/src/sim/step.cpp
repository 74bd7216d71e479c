#include "birm3d/sim/step.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/sim/barrier_forces.hpp"
#include "birm3d/sim/half_kick.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A slope that changes within the step costs up to an eighth of the departure it makes (m/s).
double error_of(const Unit& unit, const BodyState& body, const Wrench& departure, double dt) {
    const double gyration = std::sqrt(0.5 * unit.body.inertia.trace() * unit.body.inverse_mass);
    const Vec3 turning = inverse_inertia_in_world(unit.body, body) * departure.torque;
    return dt / 8.0 * (unit.body.inverse_mass * departure.force.norm() + gyration * turning.norm());
}

// The load at the new instant, its rate, and what the third order adds to the trapezoid rule. Returns the
// estimated error of the step's velocity (m/s).
double load_and_correct(const Unit& unit, const UnitMotion& before, double dt, UnitMotion& now,
                        ThirdOrder& extra) {
    now.load = now.skin.contact;
    now.load += now.skin.friction;
    if (now.skin.normal_force == 0.0) {
        // Nothing presses any more: the rate ends with the load, and a straight line is the better course
        // through the corner that a release makes.
        now.load_rate = {};
        now.normal_rate = now.rate_step = 0.0;
        return error_of(unit, now.body, difference(now.load, before.load), dt);
    }
    now.rate_step = dt;
    now.load_rate = scaled(difference(now.load, before.load), 1.0 / dt);
    now.normal_rate = (now.skin.normal_force - before.skin.normal_force) / dt;

    // How far the load departs from a straight line over this step and the last.
    const Wrench departure = scaled(difference(now.load_rate, before.load_rate), dt);
    const double normal_departure = dt * (now.normal_rate - before.normal_rate);
    double weight = -dt * dt / (6.0 * (dt + before.rate_step));
    // A wall does not pull: the parabola of the normal force stays above zero while its bend is at most
    // (sqrt(F0) + sqrt(F1))^2.
    const double bend = 6.0 / dt * weight * normal_departure;
    const double root = std::sqrt(before.skin.normal_force) + std::sqrt(now.skin.normal_force);
    if (-bend > root * root) weight *= root * root / -bend;
    extra.correction = scaled(departure, weight);
    extra.normal_correction = weight * normal_departure;

    return error_of(unit, now.body, departure, dt);
}

// Infinite where nothing pushes.
double critical_step(const SkinForces& skin) {
    return skin.stiffness > 0.0 ? tolerance::critical_phase / std::sqrt(skin.stiffness) : infinity;
}

void clear(ContactImpulses& impulses) {
    std::fill(impulses.tire.begin(), impulses.tire.end(), 0.0);
    impulses.tire_friction = impulses.barrier = Vec3::Zero();
    impulses.barrier_normal = 0.0;
    impulses.member_contacts = 0;
}

void begin(const State& from, double dt, Trial& trial) {
    static_cast<Progress&>(trial.state) = from;
    trial.state.time += dt;
    trial.dt = dt;
    trial.error = 0.0;
    trial.critical_step = trial.impact_after = infinity;
    trial.at_start.happened = trial.at_end.happened = false;
    for (std::size_t u = 0; u < from.units.size(); ++u) {
        static_cast<UnitMotion&>(trial.state.units[u]) = from.units[u];
        trial.active[u].clear();
        clear(trial.impulses[u]);
        clear(trial.at_start.impulses[u]);
        clear(trial.at_end.impulses[u]);
        trial.third_order[u] = {};
        trial.third_order[u].lead = scaled(from.units[u].load_rate, dt * dt / 6.0);
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
    third_order.resize(vehicle.units.size());
}

bool Trial::body_held() const {
    const auto held = [](const ContactImpulses& sum) { return sum.member_contacts > 0; };
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

        const double error = load_and_correct(unit, from.units[u], dt, moved, trial.third_order[u]);
        trial.error = std::max(trial.error, error);
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
