#include "birm3d/ensemble/runner.hpp"

#include <chrono>

namespace birm3d {

void Runner::set_scene(const Scene& scene) {
    at_start_ = false;
    if (simulation_)
        simulation_->start(scene);
    else
        simulation_.emplace(scene);
    at_start_ = true;
}

RunSummary Runner::run(const Approach& approach, const ExtremeGroups& wanted,
                       const std::function<void()>& poll) {
    if (!(at_start_ && approach == simulation_->scene().approach)) simulation_->start(approach);
    at_start_ = false;

    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    simulation_->run(poll);
    RunSummary outcome;
    outcome.run_time = std::chrono::duration<double>(Clock::now() - start).count();

    const State& state = simulation_->state();
    outcome.end_reason = simulation_->end_reason();
    outcome.state_hash = state.hash();
    outcome.statistics = state.statistics;
    outcome.balances = state.balances;
    outcome.final_velocity = state.units.front().body.velocity;
    const Scene& scene = simulation_->scene();
    const Deflections deflections = greatest_deflections(*scene.vehicle, state);
    outcome.deflection = deflections.now;
    outcome.peak_deflection = deflections.peak;
    outcome.event = simulation_->event();
    simulation_->recorder().resample(scene, wanted.channels(), history_);
    outcome.extremes = extremes_of(history_, *scene.vehicle, scene.barrier.get(), wanted, outcome.event);
    return outcome;
}

}  // namespace birm3d
