// One explicit step, in the order of the paper's section 5.
#pragma once

#include "birm3d/sim/trial.hpp"

namespace birm3d {

// Tries a step of dt from `state`.
void try_step(const Scene& scene, const State& state, double dt, const StepOptions& options, Trial& trial);

// Makes the trial the state.
void accept(const Trial& trial, State& state);

}  // namespace birm3d
