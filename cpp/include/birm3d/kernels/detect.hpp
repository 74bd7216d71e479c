// Which nodes are at a surface (paper 5.1): signed distance and normal, block by block.
#pragma once

#include "birm3d/geometry/half_space.hpp"
#include "birm3d/state/contacts.hpp"

namespace birm3d {

// Gap and normal of the nodes x, y, z; face and nodes in the same axes.
void detect(const HalfSpace& face, const Lanes& x, const Lanes& y, const Lanes& z, BlockContact& contact);

}  // namespace birm3d
