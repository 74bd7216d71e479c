#include "birm3d/sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/sim/bodies.hpp"
#include "birm3d/sim/obstacles.hpp"
#include "birm3d/sim/outcome.hpp"
#include "birm3d/sim/panel_dents.hpp"
#include "birm3d/sim/step_limits.hpp"
#include "birm3d/sim/structure_course.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Mean velocity of the pushing nodes along their normals, weighted by their forces (m/s); negative =
// approaching, zero where nothing pushes.
double separation_speed(const Scene& scene, const State& state) {
    double power = 0.0, force = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const Twist motion = twist(scene.vehicle->units[u].body, unit.body);
        power += unit.skin.contact.force.dot(motion.velocity) +
                 unit.skin.contact.torque.dot(motion.angular_velocity);
        for (const Touch& touch : unit.touches) {
            const int other = body_of_obstacle(scene, touch.obstacle);
            if (other < 0) continue;
            const auto b = static_cast<std::size_t>(other);
            const Twist of = twist(rigid_body(scene, b), body_state(state, b));
            const Vec3 arm = unit.body.position - body_state(state, b).position;
            power -= touch.contact.force.dot(of.velocity + of.angular_velocity.cross(arm)) +
                     touch.contact.torque.dot(of.angular_velocity);
        }
        force += unit.skin.normal_force;
    }
    return force > 0.0 ? power / force : 0.0;
}

// Where the approach turns into separation within a step, the trusses' peak is passed unseen and unloading
// begins late, by up to the way back in half the step: the error in velocity is the force of that way, half
// a step long.
struct Turn {
    double share = 1.0;  // of the step at which the approach ends
    double error = 0.0;  // m/s
};
Turn find_turn(const Scene& scene, const State& before, const Trial& trial) {
    const double approach = separation_speed(scene, before);
    const double separation = separation_speed(scene, trial.state);
    if (!(approach < 0.0 && separation > 0.0)) return {};
    double stiffness = 0.0;
    for (const UnitState& unit : trial.state.units)
        stiffness = std::max(stiffness, unit.skin.stiffness);
    return {approach / (approach - separation), 0.25 * trial.dt * trial.dt * stiffness * separation};
}

// When a load is gone, by its course so far (s); infinite where that does not tell.
double time_to_release(const LoadCourse& course) {
    const double force = course.now.normal_force, rate = course.rate.normal_force,
                 bend = course.bend.normal_force, step = course.step;
    if (!(force > 0.0)) return 0.0;
    // Root of force + rate s + bend s (s + step), written for small bends.
    const double slope = rate + bend * step;
    const double square = slope * slope - 4.0 * bend * force;
    const bool ends = square > 0.0 && slope < 0.0;
    return ends ? 2.0 * force / (std::sqrt(square) - slope) : infinity;
}

// Of the last load.
double time_to_release(const Scene& scene, const State& state) {
    double latest = 0.0;
    for (const UnitState& unit : state.units)
        for (std::size_t i = 0; i < unit.touches.size();) {
            const std::size_t structure = scene.obstacles[unit.touches[i].obstacle].structure;
            latest = std::max(latest, time_to_release(course_of_structure(scene, unit.touches, structure)));
            i = end_of_structure(scene, unit.touches, i);
        }
    return latest;
}

// A step at whose end the next segment that slides straight on, untouched, comes to rest (s): its way is exact then.
double time_to_stop(const Scene& scene, const State& state) {
    double earliest = infinity;
    if (state.segments.empty() || touches(state)) return earliest;
    const double deceleration = scene.settings.gravity * scene.barrier->free_standing->ground_friction;
    if (!(deceleration > 0.0)) return earliest;
    for (const BodyState& segment : state.segments) {
        const double time = segment.velocity.norm() / deceleration;
        if (time > tolerance::shortest_stop) earliest = std::min(earliest, time);
    }
    return earliest;
}

// Steps that an estimate asks for are taken from a ladder of sixteen lengths an octave: estimates are made of
// high differences of the load, and their rounding must not travel from step to step.
double on_ladder(double dt) {
    int octave = 0;
    const double part = std::frexp(dt, &octave);  // 0.5 to 1
    return std::ldexp(std::floor(part * 32.0) / 32.0, octave);
}

// The turning of a body in free flight and the course of tyre forces are followed to second order, which nothing
// estimates: longest step at which they keep up with the tolerance (s).
double longest_step(const Settings& settings) {
    return tolerance::longest_step * std::sqrt(std::min(1.0, settings.tolerance / Settings{}.tolerance));
}

}  // namespace

Simulation::Simulation(Scene scene)
    : scene_(std::move(scene)),
      state_(scene_.initial_state()),
      trial_(*scene_.vehicle),
      recorder_(scene_, state_) {}

void Simulation::start(const Scene& scene) {
    if (scene.vehicle != scene_.vehicle) {
        *this = Simulation(scene);
        return;
    }
    scene_ = scene;
    start(Approach(scene_.approach));
}

void Simulation::start(const Approach& approach) {
    scene_.set_approach(approach);
    scene_.start(state_);
    trial_.restart(*scene_.vehicle, state_);
    recorder_.restart(scene_, state_);
}

void Simulation::restore(const Snapshot& snapshot) {
    if (snapshot.scene != scene_.fingerprint())
        refuse("snapshot", "of a simulation of the same vehicle and barrier", "one of others");
    state_ = snapshot.state;
    trial_.restart(*scene_.vehicle, state_);
    recorder_ = snapshot.recorder;
}

EndReason Simulation::end_reason() const {
    if (remaining() > 0.0) return EndReason::running;
    if (scene_.duration) return EndReason::duration;
    if (!state_.decided) return EndReason::longest;
    return has_left(scene_, state_) ? EndReason::separated : EndReason::stopped;
}

double Simulation::deepest_node() const {
    return std::max(0.0, -nearest_gap(scene_, state_, {}));
}

double Simulation::deepest_anchor() const {
    return std::max(0.0, -nearest_gap(scene_, state_, {.nodes = false, .anchors = true}));
}

double Simulation::remaining() const {
    double end = tolerance::longest_event;
    if (scene_.duration)
        end = *scene_.duration;
    else if (state_.decided)
        end = state_.decided_at + tolerance::tail_duration;
    const double rest = end - state_.time;
    return rest > tolerance::shortest_step ? rest : 0.0;  // no step for what rounding leaves over
}

void Simulation::take(Trial& trial) {
    const bool open = scene_.barrier && !state_.decided;
    if (open) list_body_states(state_, before_);
    const double released = open ? std::min(time_to_release(scene_, state_), trial.dt) : 0.0;
    accept(scene_, trial, state_);
    recorder_.add(scene_, trial);
    if (!std::isfinite(state_.energies.total()))
        throw std::runtime_error("the state is no longer finite at t = " + to_text(state_.time) +
                                 " s, step " + to_text(trial.dt) + " s");
    if (open && state_.touched && is_decided(scene_, state_)) {
        state_.decided = true;
        state_.decided_at = time_of_decision(scene_, before_, released, trial.dt, trial.state);
    }
}

void Simulation::fixed_step() {
    const double step = *scene_.settings.time_step;
    const double dt = std::min(step, remaining());
    const double passing = passing_step(scene_, state_, dt);
    if (passing < dt) refuse_step(dt, passing);
    try_step(scene_, state_, dt, {}, trial_);
    double critical = trial_.critical_step;
    if (trial_.body_held()) {
        // The rigid body was held: would the trusses have stopped it, had the step been short enough to see
        // them? Look at them on the way there.
        Trial free(*scene_.vehicle);
        for (double part = dt; part > 1e-3 * dt; part *= 0.5) {
            try_step(scene_, state_, part, {.hold_members = false}, free);
            critical = std::min(critical, free.critical_step);
        }
    }
    if (dt > critical) refuse_step(dt, critical);
    take(trial_);
}

void Simulation::refuse_step(double dt, double critical) const {
    Settings adaptive = scene_.settings;
    adaptive.time_step.reset();
    Simulation other(Scene(scene_.vehicle, scene_.barrier, scene_.approach, adaptive, scene_.duration));
    other.run([] {});
    const double would_do =
        tolerance::advised_fraction * std::min(critical, other.state().statistics.least_critical_step);
    throw UnstableError(dt, critical, state_.time,
                        "a step of " + to_text(would_do, 3) + " s would do for the whole run");
}

void Simulation::adaptive_step() {
    const double allowed =
        tolerance::step_error_per_tolerance * scene_.settings.tolerance * scene_.reference_speed();
    double dt = passing_step(scene_, state_,
                             std::min({state_.next_step, longest_step(scene_.settings), remaining()}));
    dt = std::min(dt, time_to_stop(scene_, state_));
    if (touches(state_))
        dt = std::min(dt, std::max(time_to_release(scene_, state_), tolerance::release_resolution));
    bool lands = false;
    double cut = 0.0;  // what an impact has cut short: the next step is no shorter for it (s)
    for (;;) {
        if (dt < tolerance::shortest_step)
            throw UnstableError(dt, tolerance::shortest_step, state_.time,
                                "the scene is too stiff for any step worth taking");
        try_step(scene_, state_, dt, {.locate_impacts = true}, trial_);
        if (trial_.impact_within()) {
            cut = std::max(cut, dt);
            dt = std::max(trial_.impact_after, 2.0 * tolerance::shortest_step);
            ++state_.statistics.rejected;
            continue;
        }
        if (!lands && !touches(state_) && touches(trial_.state)) {
            // The end of free flight: no further than to the first instant at which a node can be at the barrier.
            lands = true;
            const double landing =
                std::max(tolerance::first_contact_step, untouched_step(scene_, state_, dt));
            if (landing < dt) {
                dt = landing;
                ++state_.statistics.rejected;
                continue;
            }
        }
        const double stable = tolerance::stable_fraction * trial_.critical_step;
        double wanted = dt;
        if (dt > stable) wanted = 0.9 * stable;
        if (trial_.error > allowed && dt > tolerance::jump_resolution)
            wanted = std::min(wanted, std::max(dt * std::max(0.2, 0.9 * std::sqrt(allowed / trial_.error)),
                                               tolerance::jump_resolution));
        double shorter = wanted < dt ? on_ladder(wanted) : infinity;
        const Turn turn = find_turn(scene_, state_, trial_);
        if (turn.error > allowed) shorter = std::min(shorter, dt * std::clamp(turn.share, 0.1, 0.9));
        if (dt > tolerance::release_resolution && touches(state_) && !touches(trial_.state))
            shorter = std::min(shorter, std::max(0.5 * dt, tolerance::release_resolution));
        if (!(shorter < dt)) break;
        dt = shorter;
        ++state_.statistics.rejected;
    }
    take(trial_);

    // The sixth root rather than the fourth, by which a smooth load's error grows: gentle changes of the step
    // keep the estimates, which compare three steps, quiet.
    const double growth = 0.9 * std::pow(allowed / std::max(trial_.error, 1e-300), 1.0 / 6.0);
    const double longer = growth > 1.0 ? std::max(dt * std::min(4.0, growth), cut)
                                       : std::max(dt * growth, tolerance::jump_resolution);
    const double next = on_ladder(std::min(longer, 0.9 * tolerance::stable_fraction * trial_.critical_step));
    state_.next_step = std::min(next, longest_step(scene_.settings));
}

bool Simulation::step() {
    if (finished()) return false;
    if (scene_.settings.time_step)
        fixed_step();
    else
        adaptive_step();
    return true;
}

void Simulation::run(const std::function<void()>& poll) {
    constexpr int steps_between_polls = 256;
    for (int i = 1; step(); ++i)
        if (i % steps_between_polls == 0) poll();
}

}  // namespace birm3d
