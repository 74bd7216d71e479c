// One explicit step, in the order of the paper's section 5: half a kick by the forces, drift, new forces,
// the other half of the kick. With the skin's load W, its divided differences W' and W'' over the steps h and g
// before, and W1', W1'' those that end with the new load,
//   drift with    V0 + dt/2 W0 + dt^2/6 W' + dt^2 (dt/12 + h/6) W''
//   V1 = V0 + dt/2 (W0 + W1) - dt^3/6 W1'' - dt^3 (dt/12 + h/6) / (dt + h + g) (W1'' - W'')
// (V momenta): the drift of Beeman and the kick of Adams and Moulton for steps of any length, one evaluation
// of the forces a step. Fourth order while the load's bend lasts, third (without the terms in W'' and
// W1'' - W'') after a corner, leapfrog's second order where the slope changes; stable to omega dt = sqrt(3)
// in its third order. (Beeman, J. Comput. Phys. 20, 1976, p. 130, with Schofield's corrector; Hairer, Norsett
// and Wanner, Solving Ordinary Differential Equations I, III.5, for variable steps.)
#pragma once

#include "birm3d/contact/trial.hpp"

namespace birm3d {

// Tries a step of dt from `state`.
void try_step(const Scene& scene, const State& state, double dt, const StepOptions& options, Trial& trial);

// Makes the trial the state; the trial is then only good for another try.
void accept(const Scene& scene, Trial& trial, State& state);

}  // namespace birm3d
