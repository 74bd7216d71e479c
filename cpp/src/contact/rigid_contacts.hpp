// What rigid contacts and joints do at one end of the drift: their impulses with the friction that goes with them, the
// kicks, and their place in sums and ledgers.
#pragma once

#include <span>
#include <vector>

#include "contact/trial.hpp"
#include "kernels/impulse.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Where what is lost to friction on an obstacle is booked.
double& friction_of(const Scene& scene, std::size_t obstacle, Energies& energies);

double power(const Wrench& w, const Twist& motion);
Twist mean(const Twist& a, const Twist& b);

// Units and segments as the solver sees them.
void list_bodies(const Scene& scene, const State& state, std::vector<ContactBody>& bodies);
// Brings the motions of the listed bodies up to date.
void set_motions(const State& state, std::vector<ContactBody>& bodies);

// Their motions, which are brought up to date.
void list_motions(const State& state, std::vector<ContactBody>& bodies, std::vector<Twist>& motions);

// Of a unit from an obstacle, about the unit's mass centre, world axes: mean of the bodies' motions before and after.
Twist relative_motion(const Scene& scene, const State& state, std::size_t unit, std::size_t obstacle,
                      std::span<const Twist> before, std::span<const Twist> after);

void add_impulses(const Scene& scene, const State& state, const ContactKick& kicked,
                  std::vector<ContactImpulses>& sums, std::vector<Wrench>& joints);

// Energy that the normal impulse of a contact takes from the bodies (J).
double loss_of(const RigidContact& contact, std::span<const Twist> before, std::span<const Twist> after);

// Adds the contacts' work to the energy balance, by the mean of the velocities before and after: so the change of kinetic
// energy is exact. Contacts that last have a term of their own, which is the error of the steps alone.
void book_contacts(const Scene& scene, const ContactKick& kicked, const std::vector<Twist>& before,
                   const std::vector<Twist>& after, State& state);

}  // namespace birm3d
