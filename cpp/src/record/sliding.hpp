// When a vehicle counts as one that slides on along a straight barrier, as nothing can change any more.
#pragma once

#include "birm3d/record/event.hpp"

namespace birm3d {

// After each accepted step: since when does nothing move but along the barrier's line?
void note_sliding(const Scene& scene, const State& state, Event& event);

// Does the vehicle slide along the barrier in a state that can not change? It moves neither across the line nor up, and does not
// rotate. Either nothing presses it on the barrier, or it has slid so for tolerance::rest_duration. What presses, as straight
// wheels do, also brakes it by friction. So it must stay fast enough, and beside the barrier, until the longest run ends.
bool slides_on(const Scene& scene, const State& state, const Event& event);

}  // namespace birm3d
