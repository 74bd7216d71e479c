// Estimated velocity errors of one step (m/s), and the longest stable step. control/step_control.hpp compares them with
// what Settings::tolerance allows.
#pragma once

#include "contact/trial.hpp"

namespace birm3d {

// The masses that a contact load accelerates: a unit and, where the obstacle is free-standing, its segment.
struct EffectiveInertia {
    EffectiveInertia(const RigidBody& body, const BodyState& state);

    const RigidBody& body;
    double gyration;                         // radius of gyration of the unit (m)
    Mat3 inverse_inertia;                    // of the unit, world axes (1/(kg m^2))
    const MovingElement* segment = nullptr;  // of a free-standing barrier; null: fixed, or a post
};

// Error by a load that departs from its extrapolation by `departure` at the end of the step: at most an eighth of the
// velocity that the departure would make over dt.
double velocity_error(const EffectiveInertia& inertia, const Load& departure, double dt);

// Error by the rotation of the units, which the drift follows to second order.
double rotation_error(const Scene& scene, const State& state, double dt);

// Error by the rotation of joint forces with their bodies, which the half kicks follow to second order.
double joint_error(const Scene& scene, const State& state, double dt);

// Error of the work of gravity. The bodies fall by the drift, but the energy balance counts the mean velocities of
// the half kicks. The two differ where contacts open or close. Expressed as a velocity at the scene's reference
// speed.
double weight_error(const Scene& scene, const State& from, const Trial& trial);

// Longest stable step, sqrt(3)/omega, with omega of the trusses in contact (s); infinite where none is.
double critical_step(const Scene& scene, const RigidBody& body, const UnitState& unit);

}  // namespace birm3d
