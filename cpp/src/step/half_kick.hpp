// Half a step of forces together with the impulses of rigid contacts (paper 5.2, Eq. 1): tyres on the ground,
// bottomed-out trusses at the barrier, joints, and their friction.
//
// Two half kicks enclose the drift. In the first, rigid contacts keep points from passing a surface within the step. In
// the second, contacts at their surface stop or, above tolerance::restitution_speed, rebound.
// The work of friction uses the mean of the velocities before and after, so that the change of kinetic energy is exact.
#pragma once

#include "contact/trial.hpp"

namespace birm3d {

void half_kick(const Scene& scene, Stage stage, const StepOptions& options, Trial& trial);

}  // namespace birm3d
