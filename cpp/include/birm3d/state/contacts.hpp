// Short-lived records that kernels hand to each other through the step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "birm3d/base/types.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/state/contact_load.hpp"

namespace birm3d {

// Where the forces on a block of nodes act, body axes (m).
struct Places {
    const Lanes &x, &y, &z;

    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

// One block of nodes beside a surface, body axes.
struct alignas(64) BlockContact {
    Lanes pressure;    // normal force of each node (N)
    Lanes nx, ny, nz;  // outward normal at each
    // Where friction acts (m), and the torque of a unit of normal force about the mass centre (m): not kept up at flat
    // surfaces, where they are the node and its own.
    Lanes px, py, pz, tx, ty, tz;

    Vec3 normal(std::size_t i) const { return {nx[i], ny[i], nz[i]}; }
    Places places() const { return {px, py, pz}; }
    Vec3 torque(std::size_t i) const { return {tx[i], ty[i], tz[i]}; }
    void set_normal(const Vec3& n) { nx.fill(n.x()), ny.fill(n.y()), nz.fill(n.z()); }
};

// What each node of a block sees of surfaces of any shape (body axes); its normals now are in the BlockContact.
struct alignas(64) NodeFaces {
    Lanes gap;         // of the nearest surface (m)
    Lanes bx, by, bz;  // outward normal of the same surface at the instant before
    // Of nodes that a dent draws in: b is the way itself, and a truss force along it that much greater as a normal force,
    // which acts at the place that the BlockContact says. Zero for others.
    Lanes per_force;
};

// Sums over all that a unit's skin touches, world axes.
struct SkinForces {
    Wrench contact;             // on the vehicle, without friction (N, N m)
    Wrench friction;            // N, N m
    double normal_force = 0.0;  // sum over nodes of the force along each surface normal (N)
    double work = 0.0;          // done on the trusses since the last instant, trapezoid rule (J)
    double stored = 0.0;        // elastic energy that unloading would return (J), blocks seen only
    double stiffness = 0.0;     // sum of k_unloading of pushing nodes times inverse effective mass (1/s^2)
    // Of friction, to a change of the unit's motion from `rubbed` at which it was found (kernels/friction.hpp).
    Mat6 resistance = Mat6::Zero();
    Twist rubbed;
};

// Which panels of a unit an obstacle dents (kernels/dent.hpp), bit by bit. Those it has come into from the side it never
// does until it has been in front of them again: their skin is not before it.
struct Dented {
    std::size_t obstacle = 0;
    std::uint8_t panels = 0, passed = 0;
};

enum class ContactSource { tire, member, joint };

// A row of the impulse solver: a direction in which two bodies, or a body and what is fixed, act on each other
// (world axes). Usually a point where a rigid body meets a rigid surface or another rigid body, which may push
// only; for joints also a point that is held both ways, or an axis about which turning is stopped or held.
// Along an axis `gap`, `target` and `impulse` are in rad, rad/s and N m s.
struct RigidContact {
    ContactSource source = ContactSource::tire;
    std::size_t index = 0;          // wheel, truss in mesh order, or joint
    std::size_t obstacle = 0;       // of Scene::obstacles, for members
    std::size_t body = 0;           // M_a of Eq. 1
    int other = -1;                 // M_b of Eq. 1; -1 = fixed, M_b infinite
    Vec3 arm = Vec3::Zero();        // from the body's mass centre to the point (m)
    Vec3 other_arm = Vec3::Zero();  // the same for the other body
    Vec3 normal = Vec3::UnitZ();    // from the surface towards the body; or the axis
    double gap = 0.0;               // m
    double compliance = 0.0;        // share of the inverse mass of its body
    double target = 0.0;            // least separation velocity wanted; where held, the one wanted (m/s)
    double impulse = 0.0;           // result (N s), >= 0 unless held
    bool held = false;              // acts both ways
    bool comes_hard = false;        // did it approach hard before the forces of the half step?
    bool about_axis = false;        // turns the bodies about `normal` instead of pushing along it
    double friction = 0.0;          // Coulomb coefficient of a member
    Vec3 sliding_surface = Vec3::Zero();  // velocity of the obstacle's surface there (m/s)
    Vec3 rubbing = Vec3::Zero();          // result: its friction impulse (N s)
};

// What a unit impulse does to the body: force and torque about its mass centre. The other body's is the
// opposite, at its own arm.
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
