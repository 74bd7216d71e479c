#include "kernels/tires.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Fraction of mu N that the brush model mobilises, in [-1, 1].
double brush(double normalised_slip) {
    const double s = std::min(1.0, std::abs(normalised_slip));
    const double rest = 1.0 - s;
    return std::copysign(1.0 - rest * rest * rest, normalised_slip);
}

double raised_to(WheelAt at, const Suspension& suspension) {
    switch (at) {
        case WheelAt::droop:
            return -suspension.at_rest;
        case WheelAt::rest:
            return 0.0;
        case WheelAt::bump_stop:
            return suspension.bump;
    }
    return 0.0;
}

// Where friction acts: a sprung wheel that carries load stands on the ground, wherever the body is.
Vec3 point_on_ground(const Wheel& wheel, const Mat3& R, double height) {
    Vec3 arm = lowest_point(wheel, R, 0.0);
    if (wheel.suspension.springs()) arm.z() = -height;
    return arm;
}

// A direction along the ground, turned to the left.
Vec3 turned_by(double angle, const Vec3& direction) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * direction.x() - s * direction.y(), s * direction.x() + c * direction.y(), 0.0};
}

// Greatest change of a wheel's velocity along its axle by a unit impulse there (1/kg). It is at least twice that of the
// mass centre, as the body also turns. Wheels on springs let it roll, too; fixed wheels do not.
double inverse_mass_at_wheels(const Unit& unit, const Mat3& R, double height) {
    double greatest = 2.0 * unit.body.inverse_mass;
    for (const Wheel& wheel : unit.wheels) {
        if (!wheel.suspension.springs()) continue;
        const Vec3 lever = point_on_ground(wheel, R, height).cross(R.col(1));
        const Vec3 turned = R * (unit.body.inverse_inertia * (R.transpose() * lever));
        greatest = std::max(greatest, unit.body.inverse_mass + lever.dot(turned));
    }
    return greatest;
}

}  // namespace

void find_tire_contacts(const Unit& unit, std::size_t body, const BodyState& state, WheelSet given_way,
                        WheelAt at, std::vector<RigidContact>& contacts) {
    const Mat3 R = state.orientation.toRotationMatrix();
    for (std::size_t i = 0; i < unit.wheels.size(); ++i) {
        RigidContact contact;
        contact.source = ContactSource::tire;
        contact.index = i;
        contact.body = body;
        const Wheel& wheel = unit.wheels[i];
        const bool gone = has_wheel(given_way, i);
        contact.arm = lowest_point(wheel, R, gone ? 0.0 : raised_to(at, wheel.suspension));
        if (gone) contact.arm.z() += wheel.travel;
        contact.normal = Vec3::UnitZ();
        contact.gap = state.position.z() + contact.arm.z();
        contact.compliance = tolerance::tire_compliance;
        contacts.push_back(contact);
    }
}

WheelSet overloaded(const Unit& unit, double dt, std::span<const double> normal_impulses) {
    WheelSet found = 0;
    for (std::size_t i = 0; i < normal_impulses.size(); ++i)
        if (normal_impulses[i] > unit.wheels[i].breakaway * dt) found |= WheelSet{1} << i;
    return found;
}

// Over 60 lines: both tyre models, which share the velocities at the wheels and the limits of slow motion.
Wrench tire_friction(const Unit& unit, const Settings& settings, const BodyState& state,
                     double steering_angle, const TireMotion& motion,
                     std::span<const double> normal_impulses) {
    Wrench sum;
    const double mu = settings.mu_tire;
    double total = 0.0;
    for (const double impulse : normal_impulses)
        total += impulse;
    if (mu == 0.0 || total == 0.0) return sum;

    const Mat3 R = state.orientation.toRotationMatrix();
    // Speed that friction with a coefficient of 1 would take from a wheel.
    const double speed_change = total * inverse_mass_at_wheels(unit, R, state.position.z());
    // At small slip the impulse is C N dt * v_across / v_along. A lower bound of v_along keeps it from reversing the
    // motion.
    const double slowest = settings.cornering_stiffness * speed_change;
    const auto velocity_at = [&](const Vec3& arm) -> Vec3 {
        const Vec3 now = motion.now.velocity + motion.now.angular_velocity.cross(arm);
        const Vec3 then = motion.at_end.velocity + motion.at_end.angular_velocity.cross(arm);
        return now + std::clamp(now.norm() / slowest - 1.0, 0.0, 1.0) * (then - now);
    };

    if (settings.tire_model == TireModel::skid) {
        const Vec3 moving = velocity_at(Vec3::Zero()), velocity(moving.x(), moving.y(), 0.0);
        const double speed = velocity.norm();
        const Vec3 heading = Vec3(R(0, 0), R(1, 0), 0.0).normalized();
        const double across = std::abs(heading.x() * velocity.y() - heading.y() * velocity.x());
        // The velocity is "parallel to the r-direction" (paper), up to rounding: the wheel rolls, and only brakes
        // slow it.
        const double sliding = across <= 1e-9 * speed ? settings.braking : 1.0;
        if (sliding == 0.0) return sum;
        const Vec3 direction = -sliding / std::max(speed, mu * speed_change) * velocity;
        for (std::size_t i = 0; i < normal_impulses.size(); ++i) {
            const Vec3 impulse = mu * normal_impulses[i] * direction;
            sum += {impulse, point_on_ground(unit.wheels[i], R, state.position.z()).cross(impulse)};
        }
        return sum;
    }

    const Vec3 across_raw(R(0, 1), R(1, 1), 0.0);  // the axle's direction along the ground
    const double horizontal = across_raw.norm();
    if (horizontal < 1e-9) return sum;
    const Vec3 left = across_raw / horizontal;
    const Vec3 turned_left = turned_by(steering_angle, left);
    const double brakes = settings.braking, steers = std::sqrt(1.0 - brakes * brakes);
    for (std::size_t i = 0; i < normal_impulses.size(); ++i) {
        if (normal_impulses[i] == 0.0) continue;
        const Vec3 arm = point_on_ground(unit.wheels[i], R, state.position.z());
        const Vec3 velocity = velocity_at(arm);
        const Wheel& wheel = unit.wheels[i];
        Vec3 across = wheel.steers() ? turned_left : left;
        if (wheel.camber_ratio > 0.0) {
            const double leans_right = std::atan2(R(2, 1), horizontal);
            across = turned_by(-wheel.camber_ratio * leans_right, across);
        }
        const Vec3 along(across.y(), -across.x(), 0.0);
        const double tan_slip = velocity.dot(across) / std::max(std::abs(velocity.dot(along)), slowest);
        const double fraction = brush(settings.cornering_stiffness * tan_slip / (3.0 * mu));
        // The braking part acts against the velocity; the remaining friction acts across the wheel.
        Vec3 mobilised = steers * fraction * across;
        if (brakes > 0.0) {
            const Vec3 ground_velocity(velocity.x(), velocity.y(), 0.0);
            mobilised += brakes / std::max(ground_velocity.norm(), mu * speed_change) * ground_velocity;
            mobilised /= std::max(1.0, mobilised.norm());
        }
        const Vec3 impulse = -mu * normal_impulses[i] * mobilised;
        sum += {impulse, arm.cross(impulse)};
    }
    return sum;
}

}  // namespace birm3d
