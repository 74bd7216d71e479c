#include "kernels/steering.hpp"

#include <algorithm>
#include <cmath>

namespace birm3d {

namespace {

// Steering angle at the stops (rad), 34 degrees: the mean of both wheels of a truck, whose cut is 30 to 40 degrees.
constexpr double stop = 0.6;

}  // namespace

bool steers(const Unit& unit) {
    return std::any_of(unit.wheels.begin(), unit.wheels.end(),
                       [](const Wheel& wheel) { return wheel.steers(); });
}

double steered(const Unit& unit, const Quat& orientation, const Twist& motion, double angle, double dt,
               std::span<const double> normal_impulses) {
    const Mat3 R = orientation.toRotationMatrix();
    const Vec3 left = Vec3(R(0, 1), R(1, 1), 0.0), forward(left.y(), -left.x(), 0.0);
    double sum = 0.0, step = 0.0;
    for (std::size_t i = 0; i < normal_impulses.size(); ++i) {
        const Wheel& wheel = unit.wheels[i];
        if (!wheel.steers() || !(normal_impulses[i] > 0.0)) continue;
        const Vec3 velocity = motion.velocity + motion.angular_velocity.cross(R * wheel.center);
        const double along = velocity.dot(forward);
        if (!(along > 0.0)) continue;
        const double travels = std::atan2(velocity.dot(left), along);
        sum += normal_impulses[i];
        step += normal_impulses[i] * -std::expm1(-dt / wheel.steering_time) * (travels - angle);
    }
    return sum > 0.0 ? std::clamp(angle + step / sum, -stop, stop) : angle;
}

}  // namespace birm3d
