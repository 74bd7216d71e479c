#include "birm3d/simulation/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"
#include "control/end_of_event.hpp"
#include "control/step_control.hpp"
#include "control/step_limits.hpp"
#include "kernels/integrate.hpp"
#include "record/rest.hpp"
#include "scene/barrier_overlap.hpp"
#include "scene/bodies.hpp"
#include "scene/obstacles.hpp"
#include "step/energy_balance.hpp"
#include "step/step.hpp"

namespace birm3d {

struct Simulation::Work {
    explicit Work(const Vehicle& vehicle) : trial(vehicle) {}

    Trial trial;
    std::vector<std::size_t> about;  // obstacles about a unit
    std::vector<BodyState> before;   // the bodies at the start of the step
};

Simulation::Simulation(const Simulation& other)
    : scene_(other.scene_),
      state_(other.state_),
      work_(std::make_unique<Work>(*other.work_)),
      recorder_(other.recorder_),
      event_(other.event_),
      failed_(other.failed_),
      replays_(other.replays_) {}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Simulation::Simulation(Scene scene)
    : scene_(std::move(scene)),
      state_(scene_.initial_state()),
      work_(std::make_unique<Work>(*scene_.vehicle)),
      recorder_(scene_, state_),
      event_(begin_event(scene_, state_)) {}

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
    reset();
}

void Simulation::reset() {
    scene_.start(state_);
    work_->trial.restart(*scene_.vehicle, state_);
    recorder_.restart(scene_, state_);
    event_ = begin_event(scene_, state_);
    failed_ = false;
    replays_ = true;
}

Simulation::Snapshot Simulation::snapshot() const {
    return {scene_.fingerprint(),
            scene_.approach,
            scene_.settings,
            scene_.duration,
            replays_,
            state_,
            recorder_,
            event_};
}

void Simulation::restore(const Snapshot& snapshot) {
    if (snapshot.scene != scene_.fingerprint())
        refuse("snapshot", "of a simulation of the same vehicle and barrier", "one of others");
    if (snapshot.approach != scene_.approach)
        refuse("snapshot", "of a simulation with the same speed, angle, offset, standoff, yaw and roll",
               "one with others");
    if (snapshot.settings != scene_.settings)
        refuse("snapshot", "of a simulation with the same settings", "one with others");
    if (scene_.duration && snapshot.state.time > *scene_.duration)
        refuse("snapshot", "within the duration of " + to_text(*scene_.duration) + " s",
               to_text(snapshot.state.time) + " s");
    state_ = snapshot.state;
    work_->trial.restart(*scene_.vehicle, state_);
    recorder_ = snapshot.recorder;
    event_ = snapshot.event;
    failed_ = false;
    replays_ = snapshot.replays && snapshot.duration == scene_.duration;
}

EndReason Simulation::end_reason() const {
    if (remaining() > 0.0) return EndReason::running;
    if (scene_.duration) return EndReason::duration;
    if (!state_.decided) return EndReason::longest;
    if (event_.manner == Manner::slides_on) return EndReason::sliding;
    if (!event_.left)
        return EndReason::stopped;  // in contact and at rest; springback of the skin may move it a little
    // A vehicle that left may turn so fast in the tail that `has_left` no longer holds: it is not at rest.
    const bool stopped = !has_left(scene_, state_) && rests(scene_, state_, event_);
    return stopped ? EndReason::stopped : EndReason::separated;
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
    else if (state_.time > end - tolerance::shortest_step && scene_.barrier && rolls_on(state_, event_))
        end = tolerance::longest_rolling;
    const double rest = end - state_.time;
    return rest > tolerance::shortest_step ? rest : 0.0;  // no step for a remainder of rounding
}

void Simulation::accept_trial() {
    Trial& trial = work_->trial;
    const bool undecided = scene_.barrier && !state_.decided;
    if (undecided) list_body_states(state_, work_->before);
    const double released =
        undecided || event_.touching ? std::min(time_to_release(scene_, state_), trial.dt) : 0.0;
    const double begin = state_.time;
    if (!std::isfinite(trial.state.energies.total()))
        throw std::runtime_error("the state is no longer finite at t = " + to_text(trial.state.time) +
                                 " s, step " + to_text(trial.dt) + " s");
    failed_ = true;  // reset to false at the end of this function
    check_balances(scene_, state_, trial, state_.balances);
    accept(scene_, trial, state_);
    note_overlap(scene_, work_->about, state_);
    recorder_.add(scene_, trial);
    follow_event(scene_, state_, {begin, released, trial.body_held_by_barrier()}, event_);
    if (undecided && is_decided(scene_, state_, event_)) {
        state_.decided = true;
        state_.decided_at = time_of_decision(scene_, work_->before, released, trial.dt,
                                             {event_.turned_back(), event_.is_past()}, trial.state);
    }
    const bool long_enough = state_.time >= tolerance::longest_event - tolerance::shortest_step;
    if (!state_.decided && long_enough && !(remaining() > 0.0)) judge_at_longest(scene_, state_, event_);
    failed_ = false;
}

void Simulation::fixed_step() {
    const double step = *scene_.settings.time_step;
    const double dt = std::min(step, remaining());
    const double passing = passing_step(scene_, state_, dt);
    if (passing < dt)
        refuse_step(dt, passing, "in which nothing moves further than a quarter through an element");
    try_step(scene_, state_, dt, {}, work_->trial);
    double critical = work_->trial.critical_step;
    if (work_->trial.body_held()) {
        // The rigid body met the barrier. In shorter steps the trusses might have stopped it before. Check them along
        // the path.
        Trial free(*scene_.vehicle);
        for (double part = dt; part > tolerance::shortest_trial_part * dt; part *= 0.5) {
            try_step(scene_, state_, part, {.hold_core = false}, free);
            critical = std::min(critical, free.critical_step);
        }
    }
    if (dt > critical) refuse_step(dt, critical, "the critical step of the trusses in contact");
    accept_trial();
}

void Simulation::refuse_step(double dt, double limit, const std::string& meaning) const {
    Settings adaptive = scene_.settings;
    adaptive.time_step.reset();
    Simulation other(Scene(scene_.vehicle, scene_.barrier, scene_.approach, adaptive, scene_.duration));
    other.run([] {});
    const double would_do =
        tolerance::advised_fraction * std::min(limit, other.state().statistics.least_critical_step);
    throw UnstableError("time_step must be below " + to_text(limit, 3) + " s, " + meaning +
                            ", at t = " + to_text(state_.time, 4) + " s, got " + to_text(dt) +
                            " s; a step of " + to_text(would_do, 3) + " s would do for the whole run",
                        dt, limit, state_.time);
}

void Simulation::adaptive_step() {
    StepSearch search = begin_search(scene_, state_, remaining());
    double dt = search.first;
    for (;;) {
        if (dt < tolerance::shortest_step)
            throw UnstableError("the scene is too stiff at t = " + to_text(state_.time, 4) +
                                    " s: steps would have to be shorter than " +
                                    to_text(tolerance::shortest_step) + " s",
                                dt, tolerance::shortest_step, state_.time);
        try_step(scene_, state_, dt, {.locate_impacts = true}, work_->trial);
        const double shorter = shorter_step(scene_, state_, work_->trial, search);
        if (!(shorter < dt)) break;
        dt = shorter;
        ++state_.statistics.rejected;
        state_.statistics.node_evaluations = work_->trial.state.statistics.node_evaluations;
    }
    const double next = step_after(scene_, work_->trial, search);
    accept_trial();
    state_.next_step = next;
}

bool Simulation::step() {
    if (failed_) throw std::runtime_error("the last step failed half way: reset the simulation");
    if (finished()) return false;
    if (recorder_.full())
        refuse("duration",
               "at most " + to_text(state_.time, 6) + " s, where the " +
                   std::to_string(recorder_.rows() - 1) + " steps end that a record holds",
               scene_.duration ? to_text(*scene_.duration) : "none");
    if (scene_.settings.time_step)
        fixed_step();
    else
        adaptive_step();
    return true;
}

void Simulation::run(const std::function<void()>& poll) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds between_polls(20);
    constexpr int steps_between_polls = 256;
    Clock::time_point last = Clock::now();
    for (int i = 1; step(); ++i) {
        const Clock::time_point now = Clock::now();
        if (i % steps_between_polls != 0 && now - last < between_polls) continue;
        poll();
        last = now;
    }
}

}  // namespace birm3d
