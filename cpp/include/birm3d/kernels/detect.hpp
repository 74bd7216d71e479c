// How far nodes are from a surface (paper 5.1).
#pragma once

#include "birm3d/base/lanes.hpp"
#include "birm3d/geometry/surface.hpp"

namespace birm3d {

// Signed distances of the nodes x, y, z; face and nodes in the same axes (m).
Lanes gaps(const Cylinder& face, const Lanes& x, const Lanes& y, const Lanes& z);
Lanes gaps(const HalfSpace& face, const Lanes& x, const Lanes& y, const Lanes& z);

}  // namespace birm3d
