// Half a step of forces, with the rigid contacts that stand against them (paper 5.2, Eq. 1): tyres on the
// ground, closed trusses at the barrier, and their friction.
//
// The two halves enclose the drift. Before it, contacts keep the body from passing a surface within the step;
// after it, contacts that are at their surface stop or, above tolerance::restitution_speed, rebound. Work is
// booked with the mean of the velocities before and after, which makes the change of kinetic energy exact.
#pragma once

#include "birm3d/contact/trial.hpp"

namespace birm3d {

void half_kick(const Scene& scene, Stage stage, const StepOptions& options, Trial& trial);

}  // namespace birm3d
