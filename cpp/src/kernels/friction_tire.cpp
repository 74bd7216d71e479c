#include "kernels/friction_tire.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Square of t_i below which the rotation of the wheel does not move the node along the surface.
constexpr double no_rolling = 1e-12;

Vec3 along_surface(const Vec3& v, const Vec3& normal) {
    return v - v.dot(normal) * normal;
}

// Sliding velocity divided by its magnitude, or by the speed of full friction if that is greater.
Vec3 fraction_of_full(const TireNodeContact& node, double rolling, double full_speed) {
    const Vec3 u = node.sliding + rolling * node.rolling;
    return u / std::max(u.norm(), full_speed);
}

}  // namespace

TireNodeContact tire_node_contact(const TireNode& node, std::size_t near, const Twist& motion,
                                  const Vec3& arm, const Vec3& normal, double normal_force) {
    const Vec3 u = motion.velocity + motion.angular_velocity.cross(arm);
    const Vec3 t(node.tread_r, 0.0, node.tread_t);
    return {node.wheel, near, arm, along_surface(u, normal), along_surface(t, normal), normal, normal_force};
}

double free_rolling_speed(double full_speed, std::span<const TireNodeContact> wheel) {
    // The torque of one node is zero at the q at which it slides along its spoke, and it grows with q. So the zero of
    // the total torque lies between the least and the greatest of these q.
    double low = infinity, high = -low;
    for (const TireNodeContact& node : wheel) {
        const double square = node.rolling.squaredNorm();
        if (!(square > no_rolling) || !(node.normal_force > 0.0)) continue;
        const double along_spoke = -node.sliding.dot(node.rolling) / square;
        low = std::min(low, along_spoke);
        high = std::max(high, along_spoke);
    }
    if (!(low <= high)) return 0.0;
    const auto torque = [&](double q) {
        double sum = 0.0;
        for (const TireNodeContact& node : wheel)
            sum += node.normal_force * fraction_of_full(node, q, full_speed).dot(node.rolling);
        return sum;
    };
    // The Illinois method (Dowell and Jarratt, BIT 11, 1971, p. 168). Every third round bisects, because slow sliding
    // makes corners in the torque.
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

void add_tire_node_friction(double mu, double full_speed, double rolling, const TireNodeContact& node,
                            FrictionLoad& friction_load) {
    const Vec3 u = node.sliding + rolling * node.rolling;
    const double speed = u.norm(), q = mu * node.normal_force / std::max(speed, full_speed);
    const Vec3 force = -q * u;
    friction_load.friction += {force, node.arm.cross(force)};
    if (speed < tolerance::fast_sliding * full_speed)
        friction_load.resistance += resistance(q, node.arm, node.normal);
}

}  // namespace birm3d
