// Steps in which the energy balance opens too far.
#pragma once

#include "birm3d/scene/scene.hpp"
#include "contact/trial.hpp"

namespace birm3d {

// Would a shorter step keep the energy better? `opening`: of the step tried before (J), infinite for the first; becomes that
// of this one.
bool opens_balance(const Scene& scene, const State& from, const Trial& tried, double& opening);

}  // namespace birm3d
