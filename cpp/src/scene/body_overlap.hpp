// The overlap of a rigid body and a barrier, independent of the anchors of the body's trusses.
#pragma once

#include "birm3d/geometry/box.hpp"
#include "birm3d/geometry/shape.hpp"
#include "geometry/placement.hpp"

namespace birm3d {

// Distance by which a box (body axes, m) and a shape would have to be moved apart; 0 if they do not overlap (m). It
// is the depth of the deepest point of the box in the shape, plus the depth of that point in the box. So a thin post
// in the middle of a body counts by the distance that it penetrated, not by its radius. The signed distance from a
// convex shape is a convex function: a descent from any point of the box finds the least. Other shapes are searched
// from the middle and the corners. The depth in the shape is found to about 2 % of itself.
double overlap_of_box(const Shape& shape, const Placement& now, const Box& box);

}  // namespace birm3d
