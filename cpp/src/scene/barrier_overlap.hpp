// The greatest overlap of the rigid bodies with the barrier in a run.
#pragma once

#include <vector>

#include "birm3d/scene/scene.hpp"

namespace birm3d {

// Enters the overlap of this instant into the state's statistics. `about`: memory.
void note_overlap(const Scene& scene, std::vector<std::size_t>& about, State& state);

}  // namespace birm3d
