// Friction of bottomed-out trusses, which the rigid body itself rubs with.
#pragma once

#include <span>

#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/contacts.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Coulomb friction (paper 5.4) that goes with the normal impulses of closed members: sets their friction impulses
// and returns the sum, linear and angular about the mass centre, world axes (N s, N m s). `full_speed`: sliding speed
// of full friction; `give`: greatest speed along the ground that a unit impulse gives any of the other sides (1/kg).
// Friction does not reverse a sliding, however light the other side.
Wrench core_friction(std::span<RigidContact> contacts, std::size_t body, const RigidBody& model,
                     double full_speed, const Twist& motion, double give);

}  // namespace birm3d
