// Coulomb friction of a slab that slides on the ground: at four corners of its base, each with a quarter of the load.
//
// Within half a step, with the friction impulses p_i at the corners and the motion v after them:
//   M (v - v0) = sum of J_i^T p_i,   p_i = -c u_i/|u_i| where the corner slides, |p_i| <= c where it does not,
// where u_i = J_i v is the velocity of a corner and c its share of the friction limit. v minimises the convex function
//   (v - v0) . M (v - v0) / 2 + sum of c |u_i|
// (maximum dissipation: Moreau, in Unilateral Problems in Structural Analysis, 1985). So friction never reverses the
// sliding, and a slab that friction can hold is exactly at rest.
#pragma once

#include <array>

#include "birm3d/model/vehicle.hpp"

namespace birm3d {

// Impulse of friction on the slab about its mass centre, along the ground and about the vertical (N s, N m s).
// `arm`: from the mass centre to the corners, world axes, symmetric about it (m); `motion`: without the friction;
// `limit`: friction coefficient times normal impulse of all corners (N s).
Wrench slide_friction(const RigidBody& body, const std::array<Vec3, 4>& arm, double limit,
                      const Twist& motion);

}  // namespace birm3d
