// One explicit time step, in the order of the paper's section 5.
//
//   half kick   impulses of tyres, bottomed-out trusses and joints (5.2, Eq. 1), half of the forces at the start
//   drift       positions and orientations by the velocities between the half kicks
//   detection   the nearest surface of each node (5.1) and the deflection of its truss (5.3)
//   correction  history of the loads, estimated errors (src/step/load_history.hpp, error_estimates.hpp)
//   half kick   the same with half of the forces at the end
//
// Friction (5.4) is found with the crush. The paper steps explicitly and names no scheme. Here the two half kicks have a
// predictor and a corrector for the loads of the skin: fourth order while the loads are smooth.
#pragma once

#include "contact/trial.hpp"

namespace birm3d {

// Computes a step of `dt` seconds from `state` into `trial`, which the step control then judges.
void try_step(const Scene& scene, const State& state, double dt, const StepOptions& options, Trial& trial);

// Makes the trial the state. The contents of the trial are not valid afterwards, until the next try_step().
void accept(const Scene& scene, Trial& trial, State& state);

}  // namespace birm3d
