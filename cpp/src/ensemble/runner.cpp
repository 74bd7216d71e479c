#include "birm3d/ensemble/runner.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

namespace birm3d {

namespace {

void find_greatest_deflections(const Simulation& simulation, Outcome& outcome) {
    outcome.deflection = outcome.peak_deflection = -std::numeric_limits<double>::infinity();
    const State& state = simulation.state();
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const TrussMesh& mesh = simulation.scene().vehicle->units[u].trusses;
        for (std::size_t b = 0; b < mesh.blocks; ++b) {
            const TrussBlockState& block = state.units[u].trusses.block[b];
            for (std::size_t i = 0; i < mesh.nodes_in(b); ++i) {
                outcome.deflection = std::max(outcome.deflection, block.deflection[i]);
                outcome.peak_deflection = std::max(outcome.peak_deflection, block.peak_deflection[i]);
            }
        }
    }
}

}  // namespace

void Runner::set_scene(const Scene& scene) {
    at_start_ = false;
    if (simulation_)
        simulation_->start(scene);
    else
        simulation_.emplace(scene);
    at_start_ = true;
}

Outcome Runner::run(const Approach& approach, const ExtremeGroups& wanted,
                    const std::function<void()>& poll) {
    if (!(at_start_ && approach == simulation_->scene().approach)) simulation_->start(approach);
    at_start_ = false;

    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    simulation_->run(poll);
    Outcome outcome;
    outcome.run_time = std::chrono::duration<double>(Clock::now() - start).count();

    const State& state = simulation_->state();
    outcome.end_reason = simulation_->end_reason();
    outcome.state_hash = state.hash();
    outcome.statistics = state.statistics;
    outcome.final_velocity = state.units.front().body.velocity;
    find_greatest_deflections(*simulation_, outcome);
    simulation_->recorder().resample(simulation_->scene(), wanted.channels(), history_);
    outcome.extremes = extremes_of(history_, wanted);
    return outcome;
}

}  // namespace birm3d
