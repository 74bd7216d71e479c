// Limits of the step by the surfaces around the vehicle.
#pragma once

#include "birm3d/scene/scene.hpp"
#include "scene/indentation_gaps.hpp"

namespace birm3d {

// A step of at most `longest` in which no node reaches an element of the barrier (s). Each node moves straight on
// towards the surface that is nearest now, and not so far that another surface could be nearer.
double untouched_step(const Scene& scene, const State& state, double longest);

// A step of at most `longest` in which no point of a unit goes further than a quarter through the thinnest obstacle
// in reach (s). In a longer one it could come out on the other side.
double passing_step(const Scene& scene, const State& state, double longest);

}  // namespace birm3d
