// Forces of the barrier on the skin of one unit (paper 5.1, 5.3, 5.4), by the blocks that can reach it.
#pragma once

#include "birm3d/sim/trial.hpp"

namespace birm3d {

// At the pose of trial.state, from the skin as it was in `from`.
void barrier_forces(const Scene& scene, std::size_t unit, const State& from, Trial& trial);

// Gap of the node that is nearest to the barrier (m): exact, so that it does not hang on how nodes are blocked.
double nearest_gap(const Scene& scene, const State& state);

}  // namespace birm3d
