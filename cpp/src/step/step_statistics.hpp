// Counts and extremes of accepted steps: state/state.hpp, StepStatistics.
#pragma once

#include "contact/trial.hpp"

namespace birm3d {

// Enters an accepted step into the statistics of the state that it led to.
void count_step(const Scene& scene, const Trial& accepted, State& state);

}  // namespace birm3d
