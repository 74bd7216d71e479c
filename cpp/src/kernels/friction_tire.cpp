#include "kernels/friction_tire.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Square of t_i below which the wheel's turning does not move the node along the surface.
constexpr double no_turning = 1e-12;

Vec3 along_surface(const Vec3& v, const Vec3& normal) {
    return v - v.dot(normal) * normal;
}

// Sliding over its speed, or over that of full friction.
Vec3 share_of_full(const TireNodeContact& node, double turning, double full_speed) {
    const Vec3 u = node.sliding + turning * node.turning;
    return u / std::max(u.norm(), full_speed);
}

}  // namespace

TireNodeContact tire_node_contact(const TireNode& node, std::size_t near, const Twist& motion,
                                  const Vec3& arm, const Vec3& normal, double pressure) {
    const Vec3 u = motion.velocity + motion.angular_velocity.cross(arm);
    const Vec3 t(node.turn_r, 0.0, node.turn_t);
    return {node.wheel, near, arm, along_surface(u, normal), along_surface(t, normal), normal, pressure};
}

double free_turning(double full_speed, std::span<const TireNodeContact> wheel) {
    // Each node alone has no torque where it slides along its spoke, less below and more above: the torque of all
    // grows with q, from below zero at the least of these to above zero at the greatest.
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const TireNodeContact& node : wheel) {
        const double square = node.turning.squaredNorm();
        if (!(square > no_turning) || !(node.pressure > 0.0)) continue;
        const double own = -node.sliding.dot(node.turning) / square;
        low = std::min(low, own);
        high = std::max(high, own);
    }
    if (!(low <= high)) return 0.0;
    const auto torque = [&](double q) {
        double sum = 0.0;
        for (const TireNodeContact& node : wheel)
            sum += node.pressure * share_of_full(node, q, full_speed).dot(node.turning);
        return sum;
    };
    // The Illinois method (Dowell and Jarratt, BIT 11, 1971, p. 168). Every third round halves: that finds the corners too
    // which slow sliding makes.
    constexpr double as_good = 1e-14;
    double below = torque(low), above = torque(high);
    int side = 0;  // on which the last place lay
    for (int round = 1; high - low > as_good * (std::abs(low) + std::abs(high)); ++round) {
        const double middle = 0.5 * (low + high), secant = low - below * (high - low) / (above - below);
        const double q = round % 3 != 0 && low < secant && secant < high ? secant : middle;
        if (!(low < q && q < high)) break;
        const double there = torque(q);
        if (there < 0.0) {
            low = q, below = there;
            if (side < 0) above *= 0.5;
            side = -1;
        } else {
            high = q, above = there;
            if (side > 0) below *= 0.5;
            side = 1;
        }
    }
    return 0.5 * (low + high);
}

void add_tire_node_friction(double mu, double full_speed, double turning, const TireNodeContact& node,
                            Rubbing& rubbing) {
    const Vec3 u = node.sliding + turning * node.turning;
    const double speed = u.norm(), q = mu * node.pressure / std::max(speed, full_speed);
    const Vec3 force = -q * u;
    rubbing.friction += {force, node.arm.cross(force)};
    if (speed < tolerance::fast_sliding * full_speed)
        rubbing.resistance += resistance(q, node.arm, node.normal);
}

}  // namespace birm3d
