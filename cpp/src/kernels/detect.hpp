// How far nodes are from a surface (paper 5.1).
#pragma once

#include <optional>

#include "birm3d/base/block.hpp"
#include "birm3d/geometry/shape.hpp"
#include "geometry/placement.hpp"

namespace birm3d {

// Around a block of nodes.
Box box_around(const BlockColumn& x, const BlockColumn& y, const BlockColumn& z);

// What Nearest says, for a block of nodes: signed distances (m) and outward unit normals in body axes.
struct alignas(64) NearestOfBlock {
    BlockColumn gap, nx, ny, nz;
};

// Of the nodes x, y, z (body axes, m) of a body that stands at `now`. `before`: where it stood an instant
// earlier; only meshes ask, for the way on which each node has come. `force`, unless null: of nodes that are outside and
// have no force the gap may be infinite, and then there is no normal.
void nearest_of(const Shape& shape, const Placement& now, const Placement& before, const BlockColumn& x,
                const BlockColumn& y, const BlockColumn& z, NearestOfBlock& out,
                const BlockColumn* force = nullptr);

// Can any point of a box in body axes be nearer to the surface than `margin` (m), or inside? Cheap, and never
// no where it is yes; it may be yes where it is no.
bool within_reach(const Shape& shape, const Placement& now, const Box& box, double margin);

// The plane (body axes) that is the nearest surface to every point of a box in body axes: nearest_of would
// give its gap and its normal for all of them. None where there is no such plane or this can not be seen at
// little cost: always one for half-spaces, often one for the faces along prisms, never one for posts and meshes.
std::optional<HalfSpace> flat_part(const Shape& shape, const Placement& now, const Box& box);

}  // namespace birm3d
