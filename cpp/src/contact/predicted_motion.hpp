// How bodies will move at the end of a step whose loads there are not known yet: friction and the rate of deflection
// answer it.
#pragma once

#include "contact/trial.hpp"

namespace birm3d {

// Of a unit that has drifted, body axes. The second half of the step adds what the first did, gravity and the ground's
// push too, but for the friction on the skin, which answers the motion (settled() in kernels/friction.hpp).
Twist predicted_motion(const Scene& scene, std::size_t u, const State& from, Trial& trial);

// Of the barrier's segments, in `now`: the second half goes on as the loads did.
void predict_segments(const Scene& scene, const State& from, double dt, State& now);

}  // namespace birm3d
