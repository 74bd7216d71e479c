// Short-lived records that kernels hand to each other through the step.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "birm3d/base/types.hpp"
#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

// One block of nodes beside a surface, body axes.
struct alignas(64) BlockContact {
    Lanes gap;                   // before the nodes are moved (m)
    Vec3 normal = Vec3::Zero();  // outward, of the flat surface beside all of them
    Lanes pressure;              // normal force of each node (N)
    Lanes work, stored;          // of each truss (J): see SkinForces
};

// All that a unit's skin feels at one instant; wrenches in body axes until the step turns them to the world.
struct SkinForces {
    Wrench contact;              // of the barrier on the vehicle, without friction (N, N m)
    Wrench friction;             // N, N m
    double normal_force = 0.0;   // sum over nodes of the force along each surface normal (N)
    double work = 0.0;           // done on the trusses since the last instant, trapezoid rule (J)
    double stored = 0.0;         // elastic energy that unloading would return (J), blocks seen only
    double stiffness = 0.0;      // sum of k_unloading of pushing nodes times inverse effective mass (1/s^2)
    double friction_rate = 0.0;  // sum of mu * pressure times inverse effective mass (m/s^2)

    SkinForces& operator+=(const SkinForces& o) {
        contact += o.contact;
        friction += o.friction;
        normal_force += o.normal_force;
        work += o.work;
        stored += o.stored;
        stiffness += o.stiffness;
        friction_rate += o.friction_rate;
        return *this;
    }
};

enum class ContactSource { tire, member };

// A point where a rigid body meets a rigid surface or another rigid body (world axes).
struct RigidContact {
    ContactSource source = ContactSource::tire;
    std::size_t index = 0;          // wheel, or truss in mesh order
    std::size_t body = 0;           // M_a of Eq. 1
    int other = -1;                 // M_b of Eq. 1; -1 = fixed, M_b infinite
    Vec3 arm = Vec3::Zero();        // from the body's mass centre to the point (m)
    Vec3 other_arm = Vec3::Zero();  // the same for the other body
    Vec3 normal = Vec3::UnitZ();    // from the surface towards the body
    double gap = 0.0;               // m
    double compliance = 0.0;        // share of the point's own inverse effective mass
    double target = 0.0;            // least separation velocity wanted (m/s)
    double impulse = 0.0;           // result (N s), >= 0
};

}  // namespace birm3d
