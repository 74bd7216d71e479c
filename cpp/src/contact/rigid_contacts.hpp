// Rigid contacts and joints at one end of the drift: finding them, their impulses and friction, and their terms in sums and
// balances.
#pragma once

#include <span>
#include <vector>

#include "contact/trial.hpp"
#include "kernels/impulse.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Lists in memory.contacts every rigid contact that is possible within a step of dt (s), and the constraints of joints.
void find_rigid_contacts(const Scene& scene, const State& state, double dt, const StepOptions& options,
                         KickMemory& memory);

// The energy term that friction on an obstacle adds to.
double& friction_of(const Scene& scene, std::size_t obstacle, Energies& energies);

double power(const Wrench& w, const Twist& motion);
Twist mean(const Twist& a, const Twist& b);

// Lists units and moving elements for the solver.
void list_bodies(const Scene& scene, const State& state, std::vector<ContactBody>& bodies);
// Brings the motions of the listed bodies up to date.
void set_motions(const State& state, std::vector<ContactBody>& bodies);

// Lists the motions of the bodies, after updating them.
void list_motions(const State& state, std::vector<ContactBody>& bodies, std::vector<Twist>& motions);

// Motion of a unit relative to an obstacle, about the unit's mass centre, world axes: mean of the motions before and
// after.
Twist relative_motion(const Scene& scene, const State& state, std::size_t unit, std::size_t obstacle,
                      std::span<const Twist> before, std::span<const Twist> after);

void add_impulses(const Scene& scene, const State& state, const ContactKick& kicked,
                  std::vector<ContactImpulses>& sums, std::vector<Wrench>& joints);

// Energy that the normal impulse of a contact takes from the bodies (J).
double loss_of(const RigidContact& contact, std::span<const Twist> before, std::span<const Twist> after);

// The same by its friction.
double friction_loss(const Scene& scene, const State& state, const RigidContact& contact,
                     std::span<const Twist> before, std::span<const Twist> after);

// Adds the contacts' work to the energy balance. The work uses the mean of the velocities before and after, so that
// the change of kinetic energy is exact. Joints have a term of their own. It contains only the error of the stepping
// scheme.
void book_contacts(const Scene& scene, const ContactKick& kicked, const std::vector<Twist>& before,
                   const std::vector<Twist>& after, State& state);

}  // namespace birm3d
