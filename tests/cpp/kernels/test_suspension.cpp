// Springs and dampers of wheels: loads, energy, and that the loads are the energy's derivative.
#include "kernels/suspension.hpp"

#include <vector>

#include "birm3d/base/rotation.hpp"
#include "check.hpp"
#include "kernels/integrate.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

constexpr double stiffness = 50e3, damping = 4e3, at_rest = 0.1, bump = 0.08;

Unit on_springs(double roll_ratio = 1.0) {
    std::vector<Wheel> wheels = laboratory::four_wheels();
    for (Wheel& wheel : wheels)
        wheel.suspension = {stiffness, damping, at_rest, bump, roll_ratio};
    return {laboratory::body(), laboratory::front_face(laboratory::w2_curve(), 2, 2), std::move(wheels), 1.0};
}

const Unit unit = on_springs(), on_axles = on_springs(0.4);

BodyState raised(double height, const Angles& angles = {}) {
    BodyState state;
    state.position = {0.0, 0.0, 1.0 + height};
    state.orientation = from_roll_pitch_yaw(angles);
    return state;
}

std::vector<SuspensionLoad> loads(const BodyState& state, const Twist& motion = {}, WheelSet given_way = 0,
                                  const Unit& of = unit) {
    std::vector<SuspensionLoad> found;
    find_suspension_loads(of, state, motion, given_way, found);
    return found;
}

}  // namespace

TEST("at rest each spring is compressed by what the weight asks for") {
    const std::vector<SuspensionLoad> found = loads(raised(0.0));
    CHECK(found.size() == 4);
    for (const SuspensionLoad& load : found) {
        CHECK_CLOSE(load.spring, stiffness * at_rest, 1e-9,
                    "rounding of a height of 1 m times the stiffness");
        CHECK(load.damper == 0.0);
    }
    CHECK_CLOSE(spring_energy(unit, raised(0.0), 0), 0.0, 1e-9, "the same");
}

TEST("loads are the derivative of the energy, in any pose") {
    // The last two lift the wheels of one side, of axles further than those of springs at the wheels.
    for (const Angles& angles : {Angles{},
                                 {0.05, 0.0, 0.0},
                                 {-0.03, 0.04, 1.0},
                                 {0.02, -0.05, 2.0},
                                 {0.3, 0.0, 0.5},
                                 {-0.25, 0.02, 0.0}})
        for (const Unit* of : {&unit, &on_axles}) {
            const BodyState state = raised(-0.02, angles);
            Wrench sum;
            for (const SuspensionLoad& load : loads(state, {}, 0, *of)) {
                const Vec3 force = load.spring * Vec3::UnitZ();
                sum += {force, load.arm.cross(force)};
            }
            constexpr double step = 1e-6;
            const auto slope = [&](const BodyState& more, const BodyState& less) {
                return (spring_energy(*of, more, 0) - spring_energy(*of, less, 0)) / (2.0 * step);
            };
            const auto turned = [&](const Vec3& axis, double angle) {
                BodyState other = state;
                other.orientation = Quat(Eigen::AngleAxisd(angle, axis)) * state.orientation;
                return other;
            };
            CHECK_CLOSE(sum.force.z(), -slope(raised(-0.02 + step, angles), raised(-0.02 - step, angles)),
                        1e-2, "rounding of a difference over 1e-6");
            for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())})
                CHECK_CLOSE(sum.torque.dot(axis), -slope(turned(axis, step), turned(axis, -step)), 1e-2,
                            "the same");
        }
}

TEST("a beam axle resists roll by its ratio, and bounce as its springs do") {
    const auto torque = [](const Unit& of, double roll) {
        double sum = 0.0;
        for (const SuspensionLoad& load : loads(raised(0.0, {roll, 0.0, 0.0}), {}, 0, of))
            sum += load.arm.y() * load.spring;
        return sum;
    };
    constexpr double roll = 1e-4;
    // Both have the moment of the weight as the mass centre moves over the axle's middle.
    const double tilted = 4.0 * stiffness * 0.8 * 0.8 * roll;
    CHECK_CLOSE(torque(unit, roll) - torque(on_axles, roll), -(1.0 - 0.4) * tilted, 1e-3 * tilted,
                "higher powers of the roll");
    for (const SuspensionLoad& load : loads(raised(-0.01), {}, 0, on_axles))
        CHECK_CLOSE(load.spring, stiffness * (at_rest + 0.01), 1e-9, "rounding");
    // One end carries nothing once the other one bears 2 k r / (1 + r).
    const std::vector<SuspensionLoad> tipped = loads(raised(0.05, {0.4, 0.0, 0.0}), {}, 0, on_axles);
    CHECK(tipped.size() == 2);
    const double depth = tipped[0].spring / (2.0 * stiffness * 0.4 / 1.4);
    const Mat3 R = from_roll_pitch_yaw({0.4, 0.0, 0.0}).toRotationMatrix();
    const double height = 1.05 + lowest_point(on_axles.wheels[tipped[0].wheel], R, -at_rest).z();
    CHECK_CLOSE(depth, -height, 1e-12, "rounding");
}

TEST("an axle whose one wheel has given way is a spring at the other wheel") {
    const BodyState state = raised(0.0, {0.03, 0.0, 0.0});
    const std::vector<SuspensionLoad> one = loads(state, {}, 0b0101, on_axles),
                                      other = loads(state, {}, 0b0101);
    CHECK(one.size() == 2 && other.size() == 2);
    for (std::size_t i = 0; i < one.size(); ++i)
        CHECK(one[i].spring == other[i].spring);
}

TEST("a damper resists both ways, but never pulls the body down") {
    const auto damper = [](double velocity) {
        return loads(raised(0.0), {Vec3(0.0, 0.0, velocity), Vec3::Zero()}).front().damper;
    };
    CHECK_CLOSE(damper(-0.5), 0.5 * damping, 1e-9, "rounding");
    CHECK_CLOSE(damper(0.5), -0.5 * damping, 1e-9, "rounding");
    CHECK_CLOSE(damper(50.0), -stiffness * at_rest, 1e-9, "the wheel leaves the ground");
}

TEST("a wheel in the air or one that has given way carries nothing") {
    CHECK(loads(raised(at_rest + 1e-6)).empty());
    CHECK(loads(raised(0.0), {}, 0b0101).size() == 2);
    CHECK_CLOSE(spring_energy(unit, raised(1.0), 0), -4.0 * 0.5 * stiffness * at_rest * at_rest, 1e-9,
                "less than at rest by all that the springs had");
    CHECK_CLOSE(spring_energy(unit, raised(0.0), 0b1111), spring_energy(unit, raised(1.0), 0), 1e-9,
                "the same");
}
