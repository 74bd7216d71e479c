// When a vehicle counts as one that has come to rest.
#pragma once

#include "birm3d/record/event.hpp"

namespace birm3d {

// Energy below which all is at rest: a millionth of the kinetic energy of the approach (J).
double rest_energy(const Scene& scene);

// After each accepted step: since when is all slow?
void note_creeping(const Scene& scene, const State& state, Event& event);

// Has all come to rest: with neither kinetic nor stored energy, or slow for tolerance::rest_duration?
bool rests(const Scene& scene, const State& state, const Event& event);

}  // namespace birm3d
