// Rigid impacts, Eq. 1 for all contacts that take part, at an instant of their own.
//
// Newton's restitution of several contacts at once, with friction, can increase the kinetic energy. Here neither friction
// at a point nor all normal impulses together add any:
// - where friction against the motion before the impact would accelerate a point, it acts against the mean of the motions
//     before and after; if it drives one all the same, it is left out there;
//   - then the restitution is the greatest, up to the one asked for, at which the normal impulses take no less than
//     nothing. At none, and without friction, they never do: their targets are zero, j . (v + A j) = 0, so that they
//     take j . A j / 2.
#pragma once

#include <span>

#include "contact/trial.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Does the contact approach so fast that it makes an impact?
bool approaches_hard(const RigidContact& contact, std::span<const ContactBody> bodies);

// Applies the impact of the contacts in trial.memory that arrive within `reach` (s), if there is one. Energy balance
// and record keep it apart from the forces of the step. `before`: the present motions; `after`: those after the
// impact.
void impact_at_once(const Scene& scene, Stage stage, double reach, const std::vector<Twist>& before,
                    std::vector<Twist>& after, Trial& trial);

}  // namespace birm3d
