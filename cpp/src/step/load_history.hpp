// The predictor and the corrector of the stepping scheme: fourth order in smooth loads at one evaluation a step.
//
//   dt, h, g    lengths of this step and of the two steps before
//   W0, W1      load at the start and at the end of this step
//   W', W''     first and second divided differences of the load that end at W0; W1', W1'': those that end at W1
//   V0, V1      momenta before and after this step
// The body drifts with V0 + dt/2 W0 + P,
//   predictor P = dt^2/6 W' + dt^2 (dt/12 + h/6) W''.
// Its momentum after the step is V1 = V0 + dt/2 (W0 + W1) + C,
//   corrector C = -dt^3/6 W1'' - dt^3 (dt/12 + h/6) / (dt + h + g) (W1'' - W'').
// P is the drift of Beeman (J. Comput. Phys. 20, 1976, p. 130, with Schofield's corrector). C is the corrector of
// Adams and Moulton for steps of variable length (Hairer, Norsett and Wanner, Solving Ordinary Differential
// Equations I, III.5).
//
// Order four while the load is smooth. After a corner of the load the terms in W'' and in W1'' - W'' are left out:
// order three. Where no rate is known yet, leapfrog: order two. The third-order scheme is stable for an oscillator of
// angular frequency omega up to omega dt = sqrt(3) (tolerance::critical_phase).
#pragma once

#include <vector>

#include "contact/trial.hpp"

namespace birm3d {

// Impulse P that a contact adds to the first half kick of a step of `dt` seconds.
Load predictor(const LoadHistory& before, double dt);

// Extends the load history of every contact of unit `u` by the loads at the end of the trial step, and sets their
// correctors. Returns the estimated error of the unit's velocity (m/s).
double correct_loads(const Scene& scene, std::size_t u, const UnitState& from, Trial& trial);

}  // namespace birm3d
