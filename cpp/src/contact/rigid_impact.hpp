// Rigid impacts: Eq. 1 for all contacts that take part, at one instant.
//
// Newton's restitution of several contacts at once, with friction, can increase the kinetic energy. Here neither the
// friction at a point nor all normal impulses together increase it:
// - Friction acts against the motion before the impact. Where that would accelerate a point, it acts against the mean of
//   the motions before and after the impact. A point that friction accelerates even then has no friction.
// - The restitution is the greatest one, up to Settings::restitution, at which the normal impulses dissipate energy or
//   leave it unchanged. Without restitution and friction they always dissipate: all targets are zero, so that
//   j . (v + A j) = 0, and the loss is j . A j / 2 >= 0.
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
