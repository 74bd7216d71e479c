// When the outcome of a run is known.
#pragma once

#include <span>

#include "birm3d/scene/scene.hpp"

namespace birm3d {

// Does any node push?
bool touches(const State& state);

// Is the vehicle moving away from every element, or from the box around a free-standing chain? It must be out of reach, or
// faster than any rotation could bring a point back. On a straight path a body that recedes goes on receding. It must recede
// from a sliding segment both as that moves now and as it will come to rest. A vehicle that passes the barrier must be out of
// reach, as its rear still has to pass the element.
bool has_left(const Scene& scene, const State& state);

// What is known of a vehicle that has left: did the barrier turn it back, and has it got past the barrier? See Event.
struct KnownPath {
    bool turned_back = false, is_past = false;
};

// Has the vehicle left the barrier for good, with no wheel rising and all moving elements at rest?
bool is_over(const Scene& scene, const State& state, const KnownPath& path);

// The instant within a step of dt from which the outcome is decided (s). It does not depend on the length of the
// step. The outcome is decided at the end of the step. `before`: the bodies at the start. No node pushes from
// `released` on (s after the start). `now`: the state at the end; its bodies are moved in the search and restored.
double time_of_decision(const Scene& scene, std::span<const BodyState> before, double released, double dt,
                        const KnownPath& path, State& now);

}  // namespace birm3d
