// The shapes a barrier can be made of, each in its own axes, and what the simulation asks of them.
#pragma once

#include <variant>

#include "birm3d/geometry/box.hpp"
#include "birm3d/geometry/half_space.hpp"
#include "birm3d/geometry/nearest.hpp"
#include "birm3d/geometry/post.hpp"
#include "birm3d/geometry/prism.hpp"
#include "birm3d/geometry/triangle_mesh.hpp"

namespace birm3d {

// Cheap to copy: what is large is shared and never changes.
using Shape = std::variant<HalfSpace, Post, Prism, TriangleMesh>;

// Of a point in own axes.
Nearest nearest(const Shape& shape, const Vec3& p);

// The box around the shape, own axes (m). Along an axis on which the shape has no end, `half` is infinite and
// `center` is finite.
Box bounds(const Shape& shape);

// How thick the shape is where it is thinnest (m): a point that got in by less than half of it is nearer to
// the side it came from than to the opposite one. Infinite where there is no opposite side.
//   post: its diameter; of a post that is a wall's edge infinite, as the wall stands behind it;
//   prism: least distance between two uncovered faces, not neighbours, that look away from each other;
//   mesh: least distance from the middle of a triangle straight through the body.
double thickness(const Shape& shape);

}  // namespace birm3d
