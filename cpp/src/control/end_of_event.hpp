// When the outcome of a run is known.
#pragma once

#include <span>

#include "birm3d/scene/scene.hpp"

namespace birm3d {

// Does any node push?
bool touches(const State& state);

// Moving away from every element, and either faster than any turning could bring a point back or already out of its
// reach. On a straight path what recedes goes on receding. From a segment that slides and will stop it recedes both as
// that moves now and as it will stand. What goes on past the barrier must be out of reach: the rest of the vehicle still has
// to pass the element that its mass centre recedes from.
bool has_left(const Scene& scene, const State& state);

// The same whatever the direction: moving away from every element and out of its reach.
bool is_out_of_reach(const Scene& scene, const State& state);

// Has the vehicle left for good, its wheels not rising and what slides at rest?
bool is_over(const Scene& scene, const State& state);

// Kinetic and stored energy below which all is at rest: a millionth of the kinetic energy of the approach (J).
double rest_energy(const Scene& scene);

// Has all come to rest?
bool at_rest(const Scene& scene, const State& state);

// Of a step of dt at whose end the outcome is decided: the instant from which it was (s), within the step, so that it does
// not hang on how long that is. `before`: the bodies at the start; nothing pushes from `released` on (s after the start);
// `now`: the state at the end, whose bodies are moved about meanwhile.
double time_of_decision(const Scene& scene, std::span<const BodyState> before, double released, double dt,
                        State& now);

}  // namespace birm3d
