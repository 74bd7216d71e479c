// Forces on the skin and the tires of one unit by all that their nodes touch (paper 5.1, 5.3, 5.4).
#pragma once

#include "contact/trial.hpp"

namespace birm3d {

// Finds the forces at the pose of trial.state. `from` has the nodes as they were at the start of the step.
void find_contact_forces(const Scene& scene, std::size_t unit, const State& from, Trial& trial);

}  // namespace birm3d
