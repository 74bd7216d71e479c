// Half a step of forces together with the impulses of rigid contacts (paper 5.2, Eq. 1): tyres on the ground,
// bottomed-out trusses at the barrier, joints, and their friction.
//
// Two half kicks enclose the drift. Each changes the momentum V of a body by
//   V(after) = V(before) + dt/2 W + Q + J
// with the load W at that end of the step: of the skin, the weight and the springs. Q is P of load_history.hpp in the first
// half kick and C - P in the second. J are the impulses of rigid contacts. Without J, both together are the formula of
// "One step" in docs/pages/theory.md.
//
// In the first half kick, rigid contacts keep points from passing a surface within the step. In the second, contacts at their
// surface stop or, above tolerance::restitution_speed, rebound.
// The work of friction uses the mean of the velocities before and after, so that the change of kinetic energy is exact.
#pragma once

#include "contact/trial.hpp"

namespace birm3d {

// Changes the momenta in trial.state by a half kick. If `impact_within` of the trial holds then, the step has to be shortened,
// and the kick is not complete.
void half_kick(const Scene& scene, Stage stage, const StepOptions& options, Trial& trial);

}  // namespace birm3d
