#include "control/step_control.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "control/end_of_event.hpp"
#include "control/energy_error.hpp"
#include "control/step_limits.hpp"
#include "kernels/integrate.hpp"
#include "scene/bodies.hpp"
#include "scene/obstacles.hpp"
#include "step/structure_load.hpp"

namespace birm3d {

namespace {

// Least divisor: an estimated error may be zero (m/s).
constexpr double least_error = 1e-300;

// Velocity error that a step may have (m/s).
double allowed_error(const Scene& scene) {
    return tolerance::step_error_per_tolerance * scene.settings.tolerance * scene.reference_speed();
}

// Body `b` at an end of a step: inside the step where there was an impact at that end, else as the state has it.
const BodyState& body_within(const Impact& impact, const State& state, std::size_t b) {
    if (!impact.happened) return body_state(state, b);
    return b < impact.bodies.size() ? impact.bodies[b] : impact.moving_elements[b - impact.bodies.size()];
}

// Mean velocity of the pushing nodes along their normals, weighted by their forces (m/s); negative =
// approaching, zero where nothing pushes. `impact`: at that end of the step; its change of velocity does not count.
double separation_speed(const Scene& scene, const State& state, const Impact& impact = {}) {
    double power = 0.0, force = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const Twist motion = twist(scene.vehicle->units[u].body, body_within(impact, state, u));
        power += unit.skin.contact.force.dot(motion.velocity) +
                 unit.skin.contact.torque.dot(motion.angular_velocity);
        for (const ContactLoad& load : unit.contact_loads) {
            const int other = body_of_obstacle(scene, load.obstacle);
            if (other < 0) continue;
            const auto b = static_cast<std::size_t>(other);
            const BodyState& element = body_within(impact, state, b);
            const Twist element_motion = twist(rigid_body(scene, b), element);
            const Vec3 arm = unit.body.position - element.position;
            power -=
                load.contact.force.dot(element_motion.velocity + element_motion.angular_velocity.cross(arm)) +
                load.contact.torque.dot(element_motion.angular_velocity);
        }
        force += unit.skin.normal_force;
    }
    return force > 0.0 ? power / force : 0.0;
}

// Its rate of change by what the barrier does to the vehicle (m/s^2).
double separation_rate(const Scene& scene, const State& state) {
    double rate = 0.0, force = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const RigidBody& body = scene.vehicle->units[u].body;
        const Wrench& push = unit.skin.contact;
        rate += body.inverse_mass * push.force.squaredNorm() +
                push.torque.dot(inverse_inertia_in_world(body, unit.body) * push.torque);
        force += unit.skin.normal_force;
    }
    return force > 0.0 ? rate / force : 0.0;
}

double greatest_stiffness(const State& state) {
    double stiffness = 0.0;
    for (const UnitState& unit : state.units)
        stiffness = std::max(stiffness, unit.skin.stiffness);
    return stiffness;
}

// Velocity error of a step in which the approach turns into separation (m/s). The step passes over the trusses' peak
// deflection, so that unloading begins late by up to the return distance of half a step. The error is the force of
// that deflection over half a step.
double reversal_error(double dt, double stiffness, double separation) {
    return 0.25 * dt * dt * stiffness * separation;
}

// A located velocity reversal is no nearer than this fraction to either end of the step.
constexpr double least_fraction = 0.1;

// A step that ends at the velocity reversal, or half way to it, if a longer step would pass over it (s).
double step_to_reversal(const Scene& scene, const State& state, double approach, double dt) {
    if (!(approach < 0.0)) return dt;
    const double rate = separation_rate(scene, state);
    if (!(rate > 0.0)) return dt;
    const double reversal = -approach / rate;
    const double horizon = reversal < dt ? dt : 2.0 * dt;
    if (!(reversal < horizon)) return dt;
    if (reversal_error(dt, greatest_stiffness(state), rate * (horizon - reversal)) <= allowed_error(scene))
        return dt;
    return reversal < dt ? std::max(reversal, least_fraction * dt) : 0.5 * reversal;
}

// A shorter step, to the velocity reversal that the tried step has passed (s); infinite if the error is negligible.
double located_reversal(const Scene& scene, const Trial& tried, double approach, double separation) {
    if (!(approach < 0.0 && separation > 0.0)) return infinity;
    if (reversal_error(tried.dt, greatest_stiffness(tried.state), separation) <= allowed_error(scene))
        return infinity;
    return tried.dt * std::clamp(approach / (approach - separation), least_fraction, 1.0 - least_fraction);
}

// Velocity error by nodes whose approach ends within the step, one after the other while the body rotates (m/s). The
// step passes over their peak deflections by up to a dt^2/8. Over half a step their forces are too great by that
// distance times the unloading slope.
double error_of_reversals(const Scene& scene, const Trial& tried, double separation) {
    const double rate = separation_rate(scene, tried.state);
    if (!(rate > 0.0)) return 0.0;
    double spread = 0.0;
    for (std::size_t u = 0; u < tried.state.units.size(); ++u) {
        const Unit& unit = scene.vehicle->units[u];
        const double spin = angular_velocity(unit.body, tried.state.units[u].body).norm();
        spread = std::max(spread, spin * unit.trusses.reach);
    }
    // If all nodes reverse within the step, located_reversal() shortens it.
    const double change = rate * tried.dt, fraction = change / (2.0 * spread);
    if (!(fraction < 1.0 && std::abs(separation) < spread + change)) return 0.0;
    return fraction * change * tried.dt * tried.dt / 16.0 * greatest_stiffness(tried.state);
}

// Part of the energy at disposal by which the energy of crush falls within a step. It can only grow: a long step over
// kinks of the laws returns more than the trusses have.
double fall_of_crush(const State& from, const Trial& tried) {
    return (from.energies.crushed - tried.state.energies.crushed) / from.balances.at_disposal;
}

// Time at which the parabola through the last three normal forces falls to zero (s); infinite where it does not.
double time_to_release(const LoadHistory& history) {
    const double force = history.now.normal_force, rate = history.rate.normal_force,
                 second = history.second_difference.normal_force, step = history.step;
    if (!(force > 0.0)) return 0.0;
    // First root of force + rate s + second s (s + step), in the form that keeps its digits where `second` is small.
    const double slope = rate + second * step;
    const double discriminant = slope * slope - 4.0 * second * force;
    const bool falls_to_zero = discriminant > 0.0 && slope < 0.0;
    return falls_to_zero ? 2.0 * force / (std::sqrt(discriminant) - slope) : infinity;
}

// Time in which a post that nothing pushes comes to rest (s).
double time_to_stop(const Scene& scene, const State& state, std::size_t post) {
    const auto pushes = [=](const UnitState& unit) { return pushes_on(unit, post); };
    if (std::any_of(state.units.begin(), state.units.end(), pushes)) return infinity;
    return state.moving_elements[post].angular_momentum.norm() /
           scene.barrier->moving_elements[post].plastic_moment;
}

// A step that ends when the next untouched post, or the next untouched, straight sliding segment, comes to rest (s): its
// distance is exact then.
double time_to_stop(const Scene& scene, const State& state) {
    double earliest = infinity;
    if (scene.tilts())
        for (std::size_t i = 0; i < state.moving_elements.size(); ++i) {
            const double time = time_to_stop(scene, state, i);
            if (time > tolerance::shortest_stop) earliest = std::min(earliest, time);
        }
    if (!scene.slides() || touches(state)) return earliest;
    const double deceleration = scene.settings.gravity * scene.barrier->free_standing->ground_friction;
    if (!(deceleration > 0.0)) return earliest;
    for (const BodyState& element : state.moving_elements) {
        const double time = element.velocity.norm() / deceleration;
        if (time > tolerance::shortest_stop) earliest = std::min(earliest, time);
    }
    return earliest;
}

// Rounds a step down to one of sixteen lengths an octave. Error estimates are high differences of the load; their
// rounding errors must not spread from step to step.
double quantize_step(double dt) {
    int octave = 0;
    const double part = std::frexp(dt, &octave);  // 0.5 to 1
    return std::ldexp(std::floor(part * 32.0) / 32.0, octave);
}

// Longest step for resting contacts, joints and elements that move (s). They are integrated to second order without an
// error estimate, so that the step follows from the tolerance alone. Posts that stand still need none.
double longest_step(const Scene& scene, const Trial& tried) {
    const bool moves = scene.slides() || (scene.tilts() && fastest_moving_element(scene, tried.state) > 0.0);
    if (!tried.body_rests() && scene.joints.empty() && !moves) return tolerance::longest_step;
    return tolerance::longest_resting_step *
           std::sqrt(std::min(1.0, scene.settings.tolerance / Settings{}.tolerance));
}

// The instant at which the last load ends is located to within this (s). It grows with the tolerance, between the
// value at the default tolerance and four times that.
double release_resolution(const Scene& scene) {
    const double looser = std::sqrt(scene.settings.tolerance / Settings{}.tolerance);
    return tolerance::release_resolution * std::clamp(looser, 1.0, 4.0);
}

double longest_stable(const Trial& tried) {
    return 0.9 * tolerance::stable_fraction * tried.critical_step;
}

// A step that ends free flight at the first instant at which a node can be at the barrier (s). Until the first load
// has a rate, the error is proportional to the step and to its fraction in contact.
double landing_step(const Scene& scene, const State& from, const Trial& tried, StepSearch& search) {
    const double dt = tried.dt;
    search.lands = true;
    const double free = untouched_step(scene, from, dt);
    const double in_touch = allowed_error(scene) / std::max(tried.error, least_error) * (dt - free);
    search.pressing = std::max(tolerance::first_contact_step,
                               std::min(longest_stable(tried), 0.9 * std::sqrt(dt * in_touch)));
    return free > tolerance::first_contact_step ? free : search.pressing;
}

}  // namespace

double time_to_release(const Scene& scene, const State& state) {
    double latest = 0.0;
    for (const UnitState& unit : state.units)
        for (std::size_t i = 0; i < unit.contact_loads.size();) {
            const std::size_t structure = scene.obstacles[unit.contact_loads[i].obstacle].structure;
            latest =
                std::max(latest, time_to_release(history_of_structure(scene, unit.contact_loads, structure)));
            i = end_of_structure(scene, unit.contact_loads, i);
        }
    return latest;
}

StepSearch begin_search(const Scene& scene, const State& state, double longest) {
    StepSearch search;
    double& dt = search.first;
    dt = passing_step(scene, state, std::min(state.next_step, longest));
    dt = std::min(dt, time_to_stop(scene, state));
    if (!touches(state)) return search;
    dt = std::min(dt, std::max(time_to_release(scene, state), release_resolution(scene)));
    search.approach = separation_speed(scene, state);
    dt = step_to_reversal(scene, state, search.approach, dt);
    return search;
}

double shorter_step(const Scene& scene, const State& from, const Trial& tried, StepSearch& search) {
    const double dt = tried.dt;
    if (tried.impact_within()) {
        search.cut = std::max(search.cut, dt);
        return std::max(tried.impact_after, 2.0 * tolerance::shortest_step);
    }
    const double longest = longest_step(scene, tried);
    if (dt > longest) return longest;
    if (!search.lands && !touches(from) && touches(tried.state)) {
        const double landing = landing_step(scene, from, tried, search);
        if (landing < dt) return landing;
    }
    const double allowed = allowed_error(scene);
    const double approach =
        tried.at_start.happened ? separation_speed(scene, from, tried.at_start) : search.approach;
    const double separation = separation_speed(scene, tried.state, tried.at_end);
    search.error = std::max(tried.error, error_of_reversals(scene, tried, separation));
    double target = dt;
    if (dt > tolerance::stable_fraction * tried.critical_step) target = longest_stable(tried);
    double fraction = 1.0;
    if (search.error > allowed) fraction = std::max(0.2, 0.9 * std::sqrt(allowed / search.error));
    if (fall_of_crush(from, tried) > tolerance::greatest_fall) fraction = std::min(fraction, 0.5);
    if (has_reducible_energy_error(scene, from, tried, search.energy_error))
        fraction = std::min(fraction, 0.5);
    if (fraction < 1.0 && dt > tolerance::jump_resolution)
        target = std::min(target, std::max(fraction * dt, tolerance::jump_resolution));
    double shorter = std::min(target < dt ? quantize_step(target) : infinity,
                              located_reversal(scene, tried, approach, separation));
    const double resolution = release_resolution(scene);
    if (dt > resolution && touches(from) && !touches(tried.state))
        shorter = std::min(shorter, std::max(0.5 * dt, resolution));
    return shorter < dt ? shorter : infinity;
}

double step_after(const Scene& scene, const Trial& accepted, const StepSearch& search) {
    const double dt = accepted.dt;
    const double room = allowed_error(scene) / std::max(search.error, least_error);
    // The error of a smooth load grows with the fourth power of the step. The sixth root changes the step more
    // gently, which keeps the estimates steady: they compare three steps. Far below the allowed error that is not
    // needed.
    const double growth =
        0.9 * std::max(std::pow(room, 1.0 / 6.0), std::pow(room / tolerance::ample_room, 1.0 / 3.0));
    const double longer = growth > 1.0
                              ? std::max(dt * std::min(tolerance::fastest_growth, growth), search.cut)
                              : std::max(dt * growth, tolerance::jump_resolution);
    const double next =
        std::min(quantize_step(std::min(longer, longest_stable(accepted))), longest_step(scene, accepted));
    return touches(accepted.state) ? next : std::min(next, search.pressing);
}

}  // namespace birm3d
