// How far nodes are from a surface (paper 5.1).
#pragma once

#include <optional>

#include "birm3d/base/block.hpp"
#include "birm3d/geometry/shape.hpp"
#include "geometry/placement.hpp"

namespace birm3d {

// Around a block of nodes.
Box box_around(const BlockColumn& x, const BlockColumn& y, const BlockColumn& z);

// As Nearest (geometry/nearest.hpp), for a block of nodes: signed distances (m) and outward unit normals in body
// axes.
struct alignas(64) NearestOfBlock {
    BlockColumn gap, nx, ny, nz;
};

// Finds gaps and normals of the nodes x, y, z (body axes, m) of a body at `now`. `before`: its placement at the start
// of the step; meshes need it for the path of each node. With `force` given, nodes outside that have no force may get
// an infinite gap and no normal.
void nearest_of(const Shape& shape, const Placement& now, const Placement& before, const BlockColumn& x,
                const BlockColumn& y, const BlockColumn& z, NearestOfBlock& out,
                const BlockColumn* force = nullptr);

// Can any point of a box in body axes be nearer to the surface than `margin` (m), or inside? A cheap conservative
// test: true may be wrong, false never is.
bool within_reach(const Shape& shape, const Placement& now, const Box& box, double margin);

// The plane (body axes) that is the nearest surface for all points of a box in body axes. None if there is no such
// plane, or if finding it would be costly. Half-spaces always have one, faces along prisms often, posts and meshes
// never.
std::optional<HalfSpace> flat_part(const Shape& shape, const Placement& now, const Box& box);

// Does all of the shape lie behind the plane (body axes), or touch it? Then the plane is nearer to every point than the
// shape is. False may be wrong; true may be by tolerance::behind_plane.
bool is_behind(const HalfSpace& plane, const Shape& shape, const Placement& now);

}  // namespace birm3d
