// The motion of bodies at the end of a step, predicted before the loads there are known. Friction and the rate of
// deflection depend on it.
#pragma once

#include "contact/trial.hpp"

namespace birm3d {

// Predicted motion of a unit after the drift, body axes. The second half of the step is assumed to change the motion
// as the first half did. Only the friction on the skin is computed for the new motion (settled() in
// kernels/friction.hpp).
Twist predicted_motion(const Scene& scene, std::size_t u, const State& from, Trial& trial);

// Predicts the motions of the barrier's moving elements in `now`, from the extrapolated loads.
void predict_moving_elements(const Scene& scene, const State& from, double dt, State& now);

}  // namespace birm3d
