// Friction of bottomed-out trusses, where the rigid body itself slides on an obstacle.
#pragma once

#include <span>

#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/contacts.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Coulomb friction (paper 5.4) for the normal impulses of bottomed-out trusses. Sets their friction impulses and
// returns the sum, linear and angular about the mass centre, world axes (N s, N m s). `full_speed`: sliding speed of
// full friction. `other_inverse_mass`: greatest inverse effective mass of the obstacles along the ground (1/kg), so
// that friction does not reverse the sliding of a light obstacle.
Wrench core_friction(std::span<RigidContact> contacts, std::size_t body, const RigidBody& model,
                     double full_speed, const Twist& motion, double other_inverse_mass);

}  // namespace birm3d
