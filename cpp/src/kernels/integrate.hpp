// Free motion of a rigid body: kick (impulses change momenta) and drift (momenta move the body).
//
// Kick-drift-kick is the leapfrog scheme: explicit, second order, time-reversible. In the drift the angular momentum L
// is constant in world axes while the body rotates. P = R^T L, the same in body axes, follows Euler's equations by the
// implicit midpoint rule
//   P1 - P0 = -theta x (P0 + P1)/2,  theta = dt * I^-1 (P0 + P1)/2.
// It keeps both |P| and the rotational energy P . I^-1 P / 2 exactly. The new orientation is q1 = cayley(q0, theta).
#pragma once

#include "birm3d/base/types.hpp"
#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/body_state.hpp"

namespace birm3d {

Mat3 inverse_inertia_in_world(const RigidBody& body, const BodyState& state);

Vec3 angular_velocity(const RigidBody& body, const BodyState& state);  // world axes (rad/s)

Twist twist(const RigidBody& body, const BodyState& state);  // world axes
Twist twist_in_body_axes(const RigidBody& body, const BodyState& state);

// impulse: linear and angular, world axes, about the mass centre (N s, N m s).
void kick(const RigidBody& body, const Wrench& impulse, BodyState& state);

void drift(const RigidBody& body, double dt, BodyState& state);

double kinetic_energy(const RigidBody& body, const BodyState& state);  // J

}  // namespace birm3d
