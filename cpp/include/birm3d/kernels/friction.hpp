// Coulomb friction between the vehicle's nodes and a fixed barrier (paper 5.4): mu times the normal force,
// against the sliding direction. Called only where mu > 0.
//
// Below `full_speed` the force falls in proportion to the sliding speed, so that it brings the sliding to
// rest and never reverses it; the step sees to it that this speed is not below what the friction of all
// nodes together would undo within one step.
#pragma once

#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/contacts.hpp"

namespace birm3d {

// `motion`: the vehicle's twist in body axes. Adds friction and its rate to `forces` (body axes).
void add_friction(const RigidBody& body, double mu, double full_speed, const Twist& motion,
                  const Places& places, const BlockContact& contact, SkinForces& forces);

}  // namespace birm3d
