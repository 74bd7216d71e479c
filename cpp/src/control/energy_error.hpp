// Steps whose error of energy a shorter step would reduce.
#pragma once

#include "birm3d/scene/scene.hpp"
#include "contact/trial.hpp"

namespace birm3d {

// Asked for free-standing segments without pins that slide: does the step change the total energy by more than the limit, and is
// the change smaller than in the longer step tried before? `energy_error`: the change in that one (J), infinite for the first try;
// set to that of this one.
bool has_reducible_energy_error(const Scene& scene, const State& from, const Trial& tried,
                                double& energy_error);

}  // namespace birm3d
