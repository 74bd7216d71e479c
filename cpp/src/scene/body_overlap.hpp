// How far a rigid body and a barrier overlap, whatever points the body's trusses start from.
#pragma once

#include "birm3d/geometry/box.hpp"
#include "birm3d/geometry/shape.hpp"
#include "geometry/placement.hpp"

namespace birm3d {

// How far a box (body axes, m) and a shape would have to be moved apart; 0 where they do not overlap (m). It is the
// depth in the shape of that point of the box that lies deepest in it, and its depth in the box: so a thin post in the
// middle of a body counts by what it went through, not by its radius.
// The signed distance from a convex shape is a convex function: a descent from any point of the box finds the least. Other
// shapes are searched from the middle and the corners. The depth in the shape is found to about 2 % of itself.
double overlap_of_box(const Shape& shape, const Placement& now, const Box& box);

}  // namespace birm3d
