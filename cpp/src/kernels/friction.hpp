// Coulomb friction between the vehicle's nodes and a barrier (paper 5.4): mu times the normal force, against the sliding
// direction. Called only where mu > 0.
//
// Below `full_speed` the force falls in proportion to the sliding speed, so that it stops the sliding and never
// reverses it. Nearly sticking contacts are stiff. Therefore friction and motion at the end of a step are solved
// together, with friction linearised by `resistance`. This is the trapezoid rule, which is stable for any step.
#pragma once

#include "birm3d/state/contacts.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

struct FrictionLoad {
    Wrench friction;
    Mat6 resistance = Mat6::Zero();  // friction of nodes that slide slowly is -resistance (v, w)
};

// `motion`: the vehicle's twist in body axes. `common_normal`: where all nodes have one, or null. Adds to
// `friction_load` (body axes).
void add_friction(double mu, double full_speed, const Twist& motion, const Places& places,
                  const BlockContact& contact, const Vec3* common_normal, FrictionLoad& friction_load);

// Resistance matrix of a node at r from the mass centre, whose friction is -q times its sliding velocity.
Mat6 resistance(double q, const Vec3& r, const Vec3& normal);

// Twist u after half a step with implicit friction: M (u - motion) = -dt/2 resistance (u - before) - support u.
// `motion` is the twist with the friction of the twist `before` and without constraints. `support` is the inertia
// matrix of what keeps the body at rest (kg, kg m, kg m^2). World axes, inertia too.
Twist settled(const Twist& motion, const Twist& before, const Mat6& resistance, double dt,
              const Mat6& inertia, const Mat6& support);

}  // namespace birm3d
