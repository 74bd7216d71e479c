// Fixed-size linear algebra used throughout: SI units, double precision.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <vector>

namespace birm3d {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Quat = Eigen::Quaterniond;

// A column holds one number for every node, truss or row.
using Column = std::vector<double>;

// A length, a force or a time without limit.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

// Force and torque about the mass centre; frame stated where it is used (N, N m).
struct Wrench {
    Vec3 force = Vec3::Zero();
    Vec3 torque = Vec3::Zero();

    Wrench& operator+=(const Wrench& other) {
        force += other.force;
        torque += other.torque;
        return *this;
    }
};

inline Wrench scaled(const Wrench& w, double factor) {
    return {factor * w.force, factor * w.torque};
}

inline Wrench difference(const Wrench& a, const Wrench& b) {
    return {a.force - b.force, a.torque - b.torque};
}

// Linear and angular velocity of a rigid body in world axes (m/s, rad/s).
struct Twist {
    Vec3 velocity = Vec3::Zero();
    Vec3 angular_velocity = Vec3::Zero();
};

}  // namespace birm3d
