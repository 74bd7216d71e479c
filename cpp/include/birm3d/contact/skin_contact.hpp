// Forces on the skin of one unit by all that it touches (paper 5.1, 5.3, 5.4): by the blocks that can reach it.
#pragma once

#include "birm3d/contact/trial.hpp"

namespace birm3d {

// At the pose of trial.state, from the skin as it was in `from`.
void skin_forces(const Scene& scene, std::size_t unit, const State& from, Trial& trial);

}  // namespace birm3d
