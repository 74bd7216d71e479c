#include "kernels/suspension.hpp"

#include <algorithm>

namespace birm3d {

bool has_springs(const Unit& unit) {
    return std::any_of(unit.wheels.begin(), unit.wheels.end(),
                       [](const Wheel& wheel) { return wheel.suspension.springs(); });
}

void find_suspension_loads(const Unit& unit, const BodyState& state, const Twist& motion, WheelSet given_way,
                           std::vector<SuspensionLoad>& loads) {
    loads.clear();
    const Mat3 R = state.orientation.toRotationMatrix();
    for (std::size_t i = 0; i < unit.wheels.size(); ++i) {
        const Suspension& suspension = unit.wheels[i].suspension;
        if (!suspension.springs() || has_wheel(given_way, i)) continue;
        const Vec3 arm = lowest_point(unit.wheels[i], R, -suspension.at_rest);
        const double compression = -(state.position.z() + arm.z());
        if (!(compression > 0.0)) continue;
        const double rate = -(motion.velocity + motion.angular_velocity.cross(arm)).z();
        const double spring = suspension.stiffness * compression;
        loads.push_back({i, arm, spring, std::max(suspension.damping * rate, -spring)});
    }
}

double spring_energy(const Unit& unit, const BodyState& state, WheelSet given_way) {
    if (!has_springs(unit)) return 0.0;
    const Mat3 R = state.orientation.toRotationMatrix();
    double sum = 0.0;
    for (std::size_t i = 0; i < unit.wheels.size(); ++i) {
        const Suspension& suspension = unit.wheels[i].suspension;
        const double lowest = state.position.z() + lowest_point(unit.wheels[i], R, -suspension.at_rest).z();
        const double compression = has_wheel(given_way, i) ? 0.0 : std::max(0.0, -lowest);
        sum += 0.5 * suspension.stiffness *
               (compression * compression - suspension.at_rest * suspension.at_rest);
    }
    return sum;
}

}  // namespace birm3d
