// Coulomb friction between the vehicle's nodes and a barrier (paper 5.4): mu times the normal force, against the sliding
// direction. Called only where mu > 0.
//
// Below `full_speed` the force falls in proportion to the sliding speed, so that it brings the sliding to rest and never
// reverses it. What nearly sticks is stiff then: friction and motion at the end of a step are found from each other,
// friction taken to go on from where it was as `resistance` says. Linear friction is so followed by the trapezoid rule,
// which holds at any step.
#pragma once

#include "birm3d/state/contacts.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

struct Rubbing {
    Wrench friction;
    Mat6 resistance = Mat6::Zero();  // friction of nodes that slide slowly is -resistance (v, w)
};

// `motion`: the vehicle's twist in body axes. `common_normal`: where all nodes have one, or null. Adds to `rubbing` (body
// axes).
void add_friction(double mu, double full_speed, const Twist& motion, const Places& places,
                  const BlockContact& contact, const Vec3* common_normal, Rubbing& rubbing);

// Of a node at r from the mass centre with a force of -q times its sliding velocity.
Mat6 resistance(double q, const Vec3& r, const Vec3& normal);

// Twist u after half a step with implicit friction: M (u - motion) = -dt/2 resistance (u - before) - held u. `motion` is the
// twist with friction frozen at the twist `before` and without constraints. `held` is the inertia matrix of what holds
// the body at rest (kg, kg m, kg m^2). World axes, inertia too.
Twist settled(const Twist& motion, const Twist& before, const Mat6& resistance, double dt,
              const Mat6& inertia, const Mat6& held);

}  // namespace birm3d
