// Where the vehicle is at the barrier: past its line, above its top, between its elements, or beyond its end.
#pragma once

#include "birm3d/record/event.hpp"

namespace birm3d {

// Cosine of the angle between the body's up axis and the vertical.
double up_cosine(const BodyState& body);

// The least of these cosines of all units.
double least_up_cosine(const State& state);

// Does the path at the approach run along the barrier's line, instead of across it?
bool runs_along_line(const Scene& scene);

// Level unit vector along the barrier's line, world axes.
Vec3 line_direction(const Event& event);

// Position of the barrier's line along `towards` (m). On a path along the line it is where the barrier begins. Across the line
// it is the far side of meshes, else 0.
double line_position(const Scene& scene, const State& state, const Vec3& towards);

// How far the mass centre of unit 0 is past the line (m). At free-standing segments, it is past the nearest one.
double distance_past_line(const Scene& scene, const State& state, const Event& event);

// Is the top of any element under the rigid body of unit 0?
bool stands_over_barrier(const Scene& scene, const State& state);

// Is the mass centre of unit 0 behind the far side of an element over which it crossed the line?
bool is_behind_element(const Scene& scene, const State& state, const Event& event);

// Is it further from all elements than a vehicle that comes past an end of the barrier?
bool is_clear_of_barrier(const Scene& scene, const State& state, const Event& event);

// Did it cross the line where no element stands?
bool crossed_beside_elements(const Scene& scene, const State& state, const Event& event);

// Did the mass centre cross the line between two elements? Otherwise it passed beside the barrier's end.
bool passes_between(const Scene& scene, const State& state, const Event& event);

// Is the mass centre of unit 0 beyond the barrier's end in the direction in which the unit moves along the line?
bool is_beyond_end(const Scene& scene, const State& state, const Event& event);

// How far the barrier goes on beyond that mass centre in that direction (m). Negative beyond its end.
double distance_to_end(const Scene& scene, const State& state, const Event& event);

}  // namespace birm3d
