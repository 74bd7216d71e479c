#include "kernels/tires.hpp"

#include <algorithm>
#include <cmath>

#include "base/sine_cosine.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Fraction of mu N that the brush model mobilises, in [-1, 1]: 1 - (1 - s)^3 up to full sliding at s = 1, odd in s. The
// formula is in "Tyres on the pavement" of docs/pages/theory.md.
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
    const auto [s, c] = sine_cosine(angle);
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

// What both rules of friction need to know of a unit on its tyres.
struct UnitOnTires {
    const Unit& unit;
    const Settings& settings;
    const TireMotion& motion;
    Mat3 R;               // body to world axes
    double height;        // of the mass centre above the ground (m)
    double speed_change;  // of a wheel in this half step by friction with a coefficient of 1 (m/s)

    // At small slip the impulse is C N dt v_across / v_along: C is the cornering stiffness, N the load. This lower bound of
    // v_along keeps it from reversing the motion.
    double slowest() const { return settings.cornering_stiffness * speed_change; }

    // Velocity at `arm` from the mass centre that friction acts against, world axes (m/s). It is that at the end of the step
    // unless the motion is slow, see TireMotion.
    Vec3 velocity_at(const Vec3& arm) const {
        const Vec3 now = motion.now.velocity + motion.now.angular_velocity.cross(arm);
        const Vec3 then = motion.at_end.velocity + motion.at_end.angular_velocity.cross(arm);
        return now + std::clamp(now.norm() / slowest() - 1.0, 0.0, 1.0) * (then - now);
    }
};

// The paper's rule (5.2): full friction against the velocity of the mass centre, unless the unit moves along r.
Wrench skid_friction(const UnitOnTires& on, std::span<const double> normal_impulses) {
    Wrench sum;
    const double mu = on.settings.mu_tire;
    const Vec3 moving = on.velocity_at(Vec3::Zero()), velocity(moving.x(), moving.y(), 0.0);
    const double speed = velocity.norm();
    const Vec3 heading = Vec3(on.R(0, 0), on.R(1, 0), 0.0).normalized();
    const double across = std::abs(heading.x() * velocity.y() - heading.y() * velocity.x());
    // The velocity is "parallel to the r-direction" (paper), up to rounding: the wheel rolls, and only brakes
    // slow it.
    const double sliding = across <= 1e-9 * speed ? on.settings.braking : 1.0;
    if (sliding == 0.0) return sum;
    const Vec3 direction = -sliding / std::max(speed, mu * on.speed_change) * velocity;
    for (std::size_t i = 0; i < normal_impulses.size(); ++i) {
        const Vec3 impulse = mu * normal_impulses[i] * direction;
        sum += {impulse, point_on_ground(on.unit.wheels[i], on.R, on.height).cross(impulse)};
    }
    return sum;
}

// Tilts from which a tyre comes to lie on its side wall, and from which it has no camber thrust (rad). Estimates.
constexpr double leaves_tread = 0.873, on_side_wall = 1.134;

double camber_of(double tilt) {
    const double on_tread = (on_side_wall - std::abs(tilt)) / (on_side_wall - leaves_tread);
    return tilt * std::clamp(on_tread, 0.0, 1.0);
}

// The direction to the left in which a wheel does not roll: along its axle, seen from above, steered and turned by camber.
Vec3 direction_across(const Wheel& wheel, const Vec3& left, const Vec3& turned_left, double horizontal,
                      const Mat3& R) {
    const Vec3& across = wheel.steers() ? turned_left : left;
    if (!(wheel.camber_ratio > 0.0)) return across;
    const double leans_right = camber_of(std::atan2(R(2, 1), horizontal));
    return turned_by(-wheel.camber_ratio * leans_right, across);
}

// The friction of a wheel at this velocity as a fraction of mu N, with its sign reversed. Brakes have the part b of the friction
// circle (Settings.braking), along the velocity. sqrt(1 - b^2) of it acts across the wheel, by the brush model, and along it as
// rolling resistance.
Vec3 mobilised_friction(const UnitOnTires& on, const Wheel& wheel, const Vec3& across, const Vec3& velocity) {
    const double mu = on.settings.mu_tire, brakes = on.settings.braking;
    const double steers = std::sqrt(1.0 - brakes * brakes);
    const Vec3 along(across.y(), -across.x(), 0.0);
    const double rolls = velocity.dot(along);
    const double tan_slip = velocity.dot(across) / std::max(std::abs(rolls), on.slowest());
    const double fraction = brush(on.settings.cornering_stiffness * tan_slip / (3.0 * mu));
    Vec3 mobilised = steers * fraction * across;
    if (wheel.rolling_resistance > 0.0) {
        const double slowed = wheel.rolling_resistance * on.speed_change;
        mobilised +=
            steers * wheel.rolling_resistance / mu * rolls / std::max(std::abs(rolls), slowed) * along;
    }
    if (brakes > 0.0) {
        const Vec3 ground_velocity(velocity.x(), velocity.y(), 0.0);
        mobilised += brakes / std::max(ground_velocity.norm(), mu * on.speed_change) * ground_velocity;
    }
    if (wheel.rolling_resistance > 0.0 || brakes > 0.0) mobilised /= std::max(1.0, mobilised.norm());
    return mobilised;
}

// The default rule: the brush model at each wheel's own slip angle.
Wrench slip_friction(const UnitOnTires& on, double steering_angle, std::span<const double> normal_impulses) {
    Wrench sum;
    const Vec3 axle(on.R(0, 1), on.R(1, 1), 0.0);  // its direction along the ground
    const double horizontal = axle.norm();
    if (horizontal < 1e-9) return sum;
    const Vec3 left = axle / horizontal;
    const Vec3 turned_left = turned_by(steering_angle, left);
    for (std::size_t i = 0; i < normal_impulses.size(); ++i) {
        if (normal_impulses[i] == 0.0) continue;
        const Wheel& wheel = on.unit.wheels[i];
        const Vec3 arm = point_on_ground(wheel, on.R, on.height);
        const Vec3 across = direction_across(wheel, left, turned_left, horizontal, on.R);
        const Vec3 mobilised = mobilised_friction(on, wheel, across, on.velocity_at(arm));
        const Vec3 impulse = -on.settings.mu_tire * normal_impulses[i] * mobilised;
        sum += {impulse, arm.cross(impulse)};
    }
    return sum;
}

// Where a bump stop stands, and how far it is from the ground.
struct Stop {
    Vec3 arm;
    double gap;
};

// The stop of a wheel at its spring. `own`, `other`: as if the stops of the axle stood at its wheels.
Stop at_spring(const Suspension& suspension, const Mat3& R, const Stop& own, const Stop& other) {
    const double ratio = suspension.roll_ratio, inside = std::sqrt(ratio);
    const double travel = (suspension.at_rest + suspension.bump) * R(2, 2);
    const AxleEnd end{travel - own.gap, travel - other.gap};
    if (end.carries(ratio) && end.opposite().carries(ratio)) {
        const double share = 0.5 * (1.0 + inside);
        return {share * own.arm + (1.0 - share) * other.arm, share * own.gap + (1.0 - share) * other.gap};
    }
    // Only this end carries load: its spring moves by this share of the wheel's travel.
    const double share = inside * (1.0 + inside) / (1.0 + ratio);
    return {own.arm, own.gap + travel * (1.0 / share - 1.0)};
}

// The bump stops of a beam axle stand at its springs, see kernels/suspension.hpp. `first`: contacts of the unit's wheels, each
// stopped where it stands.
void move_stops_to_springs(const Unit& unit, const Mat3& R, WheelSet given_way,
                           std::span<RigidContact> first) {
    for (std::size_t i = 0; i < unit.wheels.size(); ++i) {
        const std::size_t j = unit.wheels[i].opposite;
        if (j == Wheel::none || j < i || has_wheel(given_way, i) || has_wheel(given_way, j)) continue;
        const Stop one{first[i].arm, first[i].gap}, other{first[j].arm, first[j].gap};
        const auto move = [&](std::size_t k, const Stop& own, const Stop& opposite) {
            const Stop moved = at_spring(unit.wheels[k].suspension, R, own, opposite);
            first[k].arm = moved.arm, first[k].gap = moved.gap;
        };
        move(i, one, other);
        move(j, other, one);
    }
}

}  // namespace

void find_tire_contacts(const Unit& unit, std::size_t body, const BodyState& state, WheelSet given_way,
                        WheelAt at, std::vector<RigidContact>& contacts) {
    const Mat3 R = state.orientation.toRotationMatrix();
    const std::size_t first = contacts.size();
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
    if (at == WheelAt::bump_stop)
        move_stops_to_springs(unit, R, given_way, std::span(contacts).subspan(first));
}

bool may_give_way(const Unit& unit) {
    return std::any_of(unit.wheels.begin(), unit.wheels.end(),
                       [](const Wheel& wheel) { return wheel.breakaway < infinity; });
}

void follow_loads(double dt, std::span<const double> normal_impulses, std::span<double> loads) {
    constexpr double rise_time = 0.01;  // s
    for (std::size_t i = 0; i < loads.size(); ++i)
        loads[i] = (rise_time * loads[i] + normal_impulses[i]) / (rise_time + dt);
}

WheelSet overloaded(const Unit& unit, std::span<const double> loads) {
    WheelSet found = 0;
    for (std::size_t i = 0; i < loads.size(); ++i)
        if (loads[i] > unit.wheels[i].breakaway) found |= WheelSet{1} << i;
    return found;
}

Wrench tire_friction(const Unit& unit, const Settings& settings, const BodyState& state,
                     double steering_angle, const TireMotion& motion,
                     std::span<const double> normal_impulses) {
    double total = 0.0;
    for (const double impulse : normal_impulses)
        total += impulse;
    if (settings.mu_tire == 0.0 || total == 0.0) return {};
    const Mat3 R = state.orientation.toRotationMatrix();
    const double height = state.position.z();
    const UnitOnTires on{unit, settings, motion, R, height, total * inverse_mass_at_wheels(unit, R, height)};
    return settings.tire_model == TireModel::skid ? skid_friction(on, normal_impulses)
                                                  : slip_friction(on, steering_angle, normal_impulses);
}

}  // namespace birm3d
