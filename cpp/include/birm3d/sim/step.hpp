// One explicit step, in the order of the paper's section 5: half a kick by the forces, drift, new forces,
// the other half of the kick. With the rate W' of the skin's load W over the step before (length h),
//   drift with    V0 + dt/2 W0 + dt^2/6 W'
//   V1 = V0 + dt/2 (W0 + W1) - dt^2 / (6 (dt + h)) * (W1 - W0 - dt W')
// (V momenta), which is Beeman's drift and the kick of the three-point Adams-Moulton rule: one evaluation of
// the forces a step, third order while forces are smooth, leapfrog's second order where they change slope;
// stable to omega dt = sqrt(3). (Beeman, J. Comput. Phys. 20, 1976, p. 130, with Schofield's corrector.)
#pragma once

#include "birm3d/sim/trial.hpp"

namespace birm3d {

// Tries a step of dt from `state`.
void try_step(const Scene& scene, const State& state, double dt, const StepOptions& options, Trial& trial);

// Makes the trial the state.
void accept(const Trial& trial, State& state);

}  // namespace birm3d
