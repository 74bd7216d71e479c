// Closed trusses: anchors at the barrier, where the rigid body itself must be held.
#pragma once

#include <span>

#include "birm3d/geometry/surface.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/body_state.hpp"
#include "birm3d/state/contacts.hpp"

namespace birm3d {

// Adds a contact for each anchor that is at the surface or, as it now moves, will be within dt; `face` and
// `motion` in body axes, contacts in world axes.
void find_closed_members(const TrussMesh& mesh, std::size_t body, const BodyState& state, const Surface& face,
                         const Twist& motion, double dt, std::vector<RigidContact>& contacts);

// Coulomb friction (paper 5.4) that goes with the normal impulses of closed members: linear and angular
// impulse about the mass centre, world axes (N s, N m s). `full_speed`: sliding speed of full friction.
Wrench member_friction(std::span<const RigidContact> contacts, std::size_t body, const RigidBody& model,
                       double mu, double full_speed, const Twist& motion);

}  // namespace birm3d
