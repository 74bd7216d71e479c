// Rigid contacts solved together (paper Eq. 1 for many points at once): tyres, closed trusses, bodies.
//
// With A_ij the velocity that a unit impulse at contact j causes along normal i, and v the approach
// velocities without impulses, the impulses j >= 0 and the separation velocities obey
//   w = A j + v - target >= 0,   w . j = 0.
// For one contact this is Eq. 1: j = -(1 + xi) v / (1/M_a + 1/M_b + n.[I_a^-1 (r_a x n) x r_a] + ...), with
// target = -xi v. (The paper's v_rel^-1 is v_rel^-, the velocity before the impact.)
// A small compliance on the diagonal makes the shares of redundant contacts unique.
//
// Solved exactly by the active-set method of Lawson and Hanson (Solving Least Squares Problems, ch. 23):
// contacts join one by one, the worst first, and only as many as matter are ever factorised.
#pragma once

#include <span>

#include "birm3d/state/contacts.hpp"

namespace birm3d {

// A body as the solver sees it, world axes.
struct ContactBody {
    double inverse_mass = 0.0;
    Mat3 inverse_inertia = Mat3::Zero();
    Twist motion;
};

// Velocity of the contact's point along its normal, relative to the other body; negative = approaching.
double separation_velocity(const RigidContact& contact, std::span<const ContactBody> bodies);

// Denominator of Eq. 1: velocity along the normal caused by a unit impulse (1/kg).
double inverse_effective_mass(const RigidContact& contact, std::span<const ContactBody> bodies);

// Sets each contact's impulse so that its separation velocity reaches at least its target; bodies' motions
// are brought up to date. `speed_scale`: of the scene (m/s), for the tolerance.
void solve_impulses(std::span<RigidContact> contacts, std::span<ContactBody> bodies, double speed_scale);

}  // namespace birm3d
