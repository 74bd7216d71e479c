#include "kernels/suspension.hpp"

#include <algorithm>

namespace birm3d {

bool has_springs(const Unit& unit) {
    return std::any_of(unit.wheels.begin(), unit.wheels.end(),
                       [](const Wheel& wheel) { return wheel.suspension.springs(); });
}

namespace {

// Of an extended wheel: from the mass centre to its lowest point, world axes (m), and how deep that is below the ground (m).
struct Extended {
    Vec3 arm;
    double depth;
};

Extended extended(const Wheel& wheel, const BodyState& state, const Mat3& R) {
    const Vec3 arm = lowest_point(wheel, R, -wheel.suspension.at_rest);
    return {arm, -(state.position.z() + arm.z())};
}

// The wheel at the other end of the axle, if that still holds it; else null.
const Wheel* opposite_of(const Unit& unit, std::size_t i, WheelSet given_way) {
    const std::size_t other = unit.wheels[i].opposite;
    return other == Wheel::none || has_wheel(given_way, other) ? nullptr : &unit.wheels[other];
}

double mean_of(double Suspension::* number, const Suspension& own, const Suspension& other) {
    return 0.5 * (own.*number + other.*number);
}

// Compressions of an axle whose wheel `own` carries more at rest than the other. A shift s of both, against each other, makes
// the axle carry these loads at rest: k (m + ratio (d + s)) is that of `own`. Without a difference it is zero.
AxleEnd preloaded(const Suspension& own, const Suspension& other, double ratio, const AxleEnd& depths) {
    const double carried = own.stiffness * own.at_rest - other.stiffness * other.at_rest;
    if (carried == 0.0 && own.at_rest == other.at_rest) return depths;
    const double stiffness = mean_of(&Suspension::stiffness, own, other);
    const double shift = 0.5 * (carried / (ratio * stiffness) - (own.at_rest - other.at_rest));
    return {depths.own + shift, depths.other - shift};
}

// Stiffness times compression, or damping times its rate, at a loaded end of a beam axle.
double at_end(double factor, double ratio, const AxleEnd& value, bool both_carry) {
    if (!both_carry) return 2.0 * factor * ratio / (1.0 + ratio) * value.own;
    const double mean = 0.5 * (value.own + value.other), half = 0.5 * (value.own - value.other);
    return factor * (mean + ratio * half);
}

double energy_of_axle(double stiffness, double ratio, const AxleEnd& end) {
    const bool own = end.carries(ratio), other = end.opposite().carries(ratio);
    if (own && other) {
        const double mean = 0.5 * (end.own + end.other), half = 0.5 * (end.own - end.other);
        return stiffness * (mean * mean + ratio * half * half);
    }
    const double down = own ? end.own : other ? end.other : 0.0;
    return stiffness * ratio / (1.0 + ratio) * down * down;
}

}  // namespace

void find_suspension_loads(const Unit& unit, const BodyState& state, const Twist& motion, WheelSet given_way,
                           std::vector<SuspensionLoad>& loads) {
    loads.clear();
    const Mat3 R = state.orientation.toRotationMatrix();
    const auto compression_rate = [&](const Vec3& arm) {
        return -(motion.velocity + motion.angular_velocity.cross(arm)).z();
    };
    for (std::size_t i = 0; i < unit.wheels.size(); ++i) {
        const Suspension& suspension = unit.wheels[i].suspension;
        if (!suspension.springs() || has_wheel(given_way, i)) continue;
        const Extended own = extended(unit.wheels[i], state, R);
        double spring = 0.0, damper = 0.0;
        if (const Wheel* opposite = opposite_of(unit, i, given_way)) {
            const Extended other = extended(*opposite, state, R);
            const double ratio = suspension.roll_ratio;
            const AxleEnd end = preloaded(suspension, opposite->suspension, ratio, {own.depth, other.depth});
            if (!end.carries(ratio)) continue;
            const bool both = end.opposite().carries(ratio);
            const AxleEnd rates{compression_rate(own.arm), compression_rate(other.arm)};
            spring =
                at_end(mean_of(&Suspension::stiffness, suspension, opposite->suspension), ratio, end, both);
            damper =
                at_end(mean_of(&Suspension::damping, suspension, opposite->suspension), ratio, rates, both);
        } else {
            if (!(own.depth > 0.0)) continue;
            spring = suspension.stiffness * own.depth;
            damper = suspension.damping * compression_rate(own.arm);
        }
        loads.push_back({i, own.arm, spring, std::max(damper, -spring)});
    }
}

double spring_energy(const Unit& unit, const BodyState& state, WheelSet given_way) {
    if (!has_springs(unit)) return 0.0;
    const Mat3 R = state.orientation.toRotationMatrix();
    double sum = 0.0;
    for (std::size_t i = 0; i < unit.wheels.size(); ++i) {
        const Suspension& suspension = unit.wheels[i].suspension;
        const double depth = extended(unit.wheels[i], state, R).depth;
        const Wheel* opposite = has_wheel(given_way, i) ? nullptr : opposite_of(unit, i, given_way);
        if (opposite != nullptr) {
            // Half of the axle's energy stands for each of its ends.
            const double ratio = suspension.roll_ratio,
                         stiffness = mean_of(&Suspension::stiffness, suspension, opposite->suspension);
            const auto energy = [&](double own, double other) {
                return energy_of_axle(stiffness, ratio,
                                      preloaded(suspension, opposite->suspension, ratio, {own, other}));
            };
            sum += 0.5 * energy(depth, extended(*opposite, state, R).depth) -
                   0.5 * energy(suspension.at_rest, opposite->suspension.at_rest);
            continue;
        }
        const double compression = has_wheel(given_way, i) ? 0.0 : std::max(0.0, depth);
        sum += 0.5 * suspension.stiffness *
               (compression * compression - suspension.at_rest * suspension.at_rest);
    }
    return sum;
}

}  // namespace birm3d
