// Rigid contacts and joints as rows of the impulse solver.
#pragma once

#include "birm3d/base/types.hpp"

namespace birm3d {

enum class ContactSource { tire, core, joint };

// A row of the impulse solver: a direction in which two bodies, or a body and what is fixed, act on each other (world
// axes). Usually a point where a rigid body meets a rigid surface or another rigid body, which may push only; for
// joints also a point that is held in both directions, or an axis about which rotation is limited or held. Along an
// axis `gap`, `target` and `impulse` are in rad, rad/s and N m s.
struct RigidContact {
    ContactSource source = ContactSource::tire;
    std::size_t index = 0;          // wheel, truss in mesh order, or joint
    std::size_t obstacle = 0;       // of Scene::obstacles, for bottomed-out trusses
    std::size_t body = 0;           // M_a of Eq. 1
    int other = -1;                 // M_b of Eq. 1; -1 = fixed, M_b infinite
    Vec3 arm = Vec3::Zero();        // from the body's mass centre to the point (m)
    Vec3 other_arm = Vec3::Zero();  // the same for the other body
    Vec3 normal = Vec3::UnitZ();    // from the surface towards the body; or the axis
    double gap = 0.0;               // m
    double compliance = 0.0;        // fraction of the inverse mass of its body
    double target = 0.0;      // least separation velocity; for bilateral rows the separation velocity (m/s)
    double impulse = 0.0;     // result (N s), >= 0 unless bilateral
    bool bilateral = false;   // acts both ways
    bool is_impact = false;   // did it approach hard before the forces of the half step?
    bool about_axis = false;  // turns the bodies about `normal` instead of pushing along it
    int axis = 0;             // of a sliding joint: body axis of the leading body along which `normal` points
    double most_force = infinity;  // greatest force of a sliding joint along its axis (N)
    bool slides = false;    // result of a sliding joint: `impulse` is that of `most_force`, and no unknown
    double friction = 0.0;  // Coulomb coefficient of a bottomed-out truss
    Vec3 sliding_surface = Vec3::Zero();   // velocity of the obstacle's surface there (m/s)
    Vec3 friction_impulse = Vec3::Zero();  // result: its friction impulse (N s)
};

// Is it the row of a sliding joint along which the bodies may slide?
inline bool may_slide(const RigidContact& contact) {
    return contact.most_force < infinity;
}

// Force and torque of a unit impulse on the body, about its mass centre. The other body's is the opposite, at its own
// arm.
inline Wrench unit_wrench(const RigidContact& contact, const Vec3& arm) {
    if (contact.about_axis) return {Vec3::Zero(), contact.normal};
    return {contact.normal, arm.cross(contact.normal)};
}
inline Wrench wrench_on_body(const RigidContact& contact) {
    return scaled(unit_wrench(contact, contact.arm), contact.impulse);
}
inline Wrench wrench_on_other(const RigidContact& contact) {
    return scaled(unit_wrench(contact, contact.other_arm), -contact.impulse);
}

}  // namespace birm3d
