// Coulomb friction between a wheel's tread and a barrier.
//
// The tread slides with the motion of the body, u = v + w x r, and with the rotation of the wheel about its axle. Node i
// of the tread slides with u_i + q t_i, t_i = (s x d_i)/R, where q is the rolling speed of the wheel. On the road
// q = v_r. A wheel that pushes on a barrier soon loses that speed: a car's wheel has an angular momentum of some
// 100 N m s at 30 m/s, and a friction of 30 kN takes it in 10 ms. Therefore the inertia of the wheel is neglected. A
// wheel that is free to rotate has the q at which friction has no torque about its axle:
//     sum_i F_i . t_i = 0,   F_i = -mu N_i (u_i + q t_i)/|u_i + q t_i|.
// The rest of the sliding is along the spokes: a tread that meets a barrier below and ahead of the axle is pushed up and
// back. Such a wheel neither stores nor releases energy, and the power of friction on the body is never positive. The
// torques of ground and engine are neglected, too. A locked wheel has q = 0.
//
// Below `full_speed` the force is reduced as on the skin (kernels/friction.hpp).
#pragma once

#include <span>

#include "birm3d/model/truss_mesh.hpp"
#include "kernels/friction.hpp"

namespace birm3d {

// A node of a tread that pushes on a barrier, body axes.
struct TireNodeContact {
    std::size_t wheel = 0;
    std::size_t near = 0;         // the caller's number of what it pushes on
    Vec3 arm = Vec3::Zero();      // place about the mass centre (m)
    Vec3 sliding = Vec3::Zero();  // of the body there, along the surface (m/s)
    Vec3 rolling = Vec3::Zero();  // t_i, along the surface
    Vec3 normal = Vec3::UnitZ();  // of the barrier
    double normal_force = 0.0;    // N
};

// `motion`: of the vehicle, seen from the barrier, body axes.
TireNodeContact tire_node_contact(const TireNode& node, std::size_t near, const Twist& motion,
                                  const Vec3& arm, const Vec3& normal, double normal_force);

// q of a wheel that is free to turn (m/s), from all its nodes that push; 0 where no node pushes.
double free_rolling_speed(double full_speed, std::span<const TireNodeContact> wheel);

// Adds the friction of a node to `friction_load` (body axes). `rolling`: q.
void add_tire_node_friction(double mu, double full_speed, double rolling, const TireNodeContact& node,
                            FrictionLoad& friction_load);

}  // namespace birm3d
