#include "kernels/tires.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "birm3d/base/rotation.hpp"
#include "check.hpp"
#include "laboratory.hpp"
#include "state/rigid_contact.hpp"

using namespace birm3d;

namespace {

constexpr double pi = laboratory::pi;

const Unit unit(laboratory::body(), laboratory::front_face(laboratory::w2_curve(), 2, 2),
                laboratory::four_wheels(), 1.0);

// Lowest of many points on a wheel's rim, relative to the mass centre.
double lowest_rim_point(const Wheel& wheel, const Quat& q) {
    double lowest = 1e9;
    for (int i = 0; i < 100000; ++i) {
        const double a = 2.0 * pi * i / 100000;
        lowest =
            std::min(lowest, (q * (wheel.center + wheel.radius * Vec3(std::cos(a), 0.0, std::sin(a)))).z());
    }
    return lowest;
}

// Friction at 1000 N s under each wheel.
Wrench friction(const Settings& settings, const BodyState& state, const Twist& motion,
                double normal = 1000.0) {
    return tire_friction(unit, settings, state, 0.0, {motion, motion}, std::vector<double>(4, normal));
}

}  // namespace

TEST("a tilted wheel touches the ground with its lowest point") {
    for (const Angles& angles :
         {Angles{}, {0.3, 0.0, 0.0}, {-0.2, 0.4, 1.0}, {1.2, -0.5, 2.0}, {0.0, 0.9, -2.5}}) {
        BodyState state;
        state.position = {5.0, 6.0, 1.3};
        state.orientation = from_roll_pitch_yaw(angles);
        std::vector<RigidContact> contacts;
        find_tire_contacts(unit, 0, state, 0, WheelAt::bump_stop, contacts);
        CHECK(contacts.size() == 4);
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            const double lowest = lowest_rim_point(unit.wheels[i], state.orientation);
            CHECK_CLOSE(contacts[i].arm.z(), lowest, 1e-9,
                        "nearest of 100,000 points on the rim: radius * (pi/1e5)^2 / 2");
            CHECK_CLOSE(contacts[i].gap, 1.3 + lowest, 1e-9, "the same");
            const Vec3 spoke = contacts[i].arm - state.orientation * unit.wheels[i].center;
            CHECK_CLOSE(spoke.norm(), 0.4, 1e-15, "on the rim");
            CHECK_CLOSE(spoke.dot(state.orientation * Vec3::UnitY()), 0.0, 1e-15, "in the wheel's plane");
        }
    }
}

TEST("a tilted wheel with a round tread stands beside its plane, on the lowest point of the torus") {
    Wheel wheel = unit.wheels[0];
    wheel.tread_radius = 0.15;
    for (const Angles& angles : {Angles{}, {0.3, 0.0, 0.0}, {-0.2, 0.4, 1.0}, {1.2, -0.5, 2.0}}) {
        const Mat3 R = from_roll_pitch_yaw(angles).toRotationMatrix();
        const Vec3 point = lowest_point(wheel, R, 0.0);
        double lowest = 1e9;
        for (int i = 0; i < 100000; ++i) {
            const double a = 2.0 * pi * i / 100000;
            const Vec3 ring = wheel.center + 0.25 * Vec3(std::cos(a), 0.0, std::sin(a));
            lowest = std::min(lowest, (R * ring).z() - 0.15);
        }
        CHECK_CLOSE(point.z(), lowest, 1e-9, "nearest of 100,000 points: radius * (pi/1e5)^2 / 2");
        const double beside = (point - R * wheel.center).dot(R.col(1));
        CHECK_CLOSE(beside, -0.15 * R(2, 1), 1e-15, "tread radius times the sine of the tilt");
    }
}

TEST(
    "a tilted wheel pushes to the side it leans to, as with a share of its tilt in slip, and takes no "
    "energy") {
    Unit cambered = unit;
    for (Wheel& wheel : cambered.wheels)
        wheel.camber_ratio = 0.125;
    const Settings settings;
    const std::vector<double> normal(4, 1000.0);
    const auto at = [&](const Unit& vehicle, double tilt, const Vec3& velocity) {
        BodyState state;
        state.orientation = from_roll_pitch_yaw({tilt, 0.0, 0.0});
        const Twist motion{velocity, Vec3::Zero()};
        return tire_friction(vehicle, settings, state, 0.0, {motion, motion}, normal).force;
    };
    const Vec3 ahead(20.0, 0.0, 0.0);
    CHECK(at(unit, 0.2, ahead).norm() < 1e-9);
    for (const double tilt : {-0.4, -0.1, 0.1, 0.4}) {  // positive: to the right
        const double slip = 0.125 * tilt;
        const Vec3 slips = at(unit, tilt, 20.0 * Vec3(std::cos(slip), std::sin(slip), 0.0));
        const Vec3 leans = at(cambered, tilt, ahead);
        CHECK_CLOSE((leans - from_roll_pitch_yaw({0.0, 0.0, -slip}) * slips).norm(), 0.0, 1e-9, "rounding");
        CHECK(leans.y() * tilt < 0.0);
        for (const double across : {-2.0, 0.0, 0.3, 2.0}) {
            const Vec3 velocity(20.0, across, 0.0);
            CHECK(at(cambered, tilt, velocity).dot(velocity) <= 1e-9);
        }
    }
}

TEST("a rolling wheel resists along its plane by its share of the load, and does not roll back") {
    Unit rolling = unit;
    for (Wheel& wheel : rolling.wheels)
        wheel.rolling_resistance = 0.015;
    const Settings settings;
    const BodyState upright;
    const std::vector<double> normal(4, 1000.0);
    const auto at = [&](const Vec3& velocity) {
        const Twist motion{velocity, Vec3::Zero()};
        return tire_friction(rolling, settings, upright, 0.0, {motion, motion}, normal).force;
    };
    for (const double speed : {-20.0, 20.0})
        CHECK_CLOSE((at({speed, 0.0, 0.0}) - Vec3(-std::copysign(60.0, speed), 0.0, 0.0)).norm(), 0.0, 1e-9,
                    "0.015 of 4,000 N s");
    const double slow = 1e-3, impulse = -at({slow, 0.0, 0.0}).x();
    CHECK(impulse > 0.0 && impulse * rolling.body.inverse_mass <= slow);
    CHECK(at({20.0, 20.0, 0.0}).norm() <= settings.mu_tire * 4000.0 + 1e-9);
}

TEST("a wheel gives way beyond its load, and is pushed up by its travel") {
    Unit weak = unit;
    weak.wheels[1].breakaway = 5000.0;
    weak.wheels[1].travel = 0.25;
    CHECK(may_give_way(weak) && !may_give_way(unit));
    CHECK(overloaded(weak, std::vector<double>(4, 5000.0)) == 0);
    const WheelSet gone = overloaded(weak, std::vector<double>(4, 5001.0));
    CHECK(gone == 2 && has_wheel(gone, 1) && !has_wheel(gone, 0) && !has_wheel(gone, 64));
    std::vector<RigidContact> contacts;
    find_tire_contacts(weak, 0, BodyState(), gone, WheelAt::bump_stop, contacts);
    CHECK(contacts.size() == 4);
    CHECK_CLOSE(contacts[1].gap - contacts[0].gap, 0.25, 1e-15, "exact but for rounding");
}

TEST("the load that wheels give way under is that of 10 ms, whatever the steps") {
    // A blow of 300 N s within a step has a load of 30 kN, and not of 300 N s over the step.
    for (const double dt : {1e-3, 1e-5, 1e-7}) {
        std::vector<double> loads(1, 0.0);
        follow_loads(dt, std::vector{300.0}, loads);
        CHECK_CLOSE(loads[0], 30e3 / (1.0 + 100.0 * dt), 1e-9, "impulse over the rise time");
        for (double time = 0.0; time < 0.2; time += 1e-3)
            follow_loads(1e-3, std::vector{20.0}, loads);
        CHECK_CLOSE(loads[0], 20e3, 1.0, "the load of 20 N s in each ms, after 20 rise times");
    }
}

TEST("a wheel that lies flat is held at its centre") {
    BodyState state;
    state.orientation = from_roll_pitch_yaw({0.5 * pi, 0.0, 0.0});
    std::vector<RigidContact> contacts;
    find_tire_contacts(unit, 0, state, 0, WheelAt::bump_stop, contacts);
    for (std::size_t i = 0; i < contacts.size(); ++i)
        CHECK_CLOSE((contacts[i].arm - state.orientation * unit.wheels[i].center).norm(), 0.0, 1e-15,
                    "exact but for rounding");
}

TEST("a wheel that rolls straight ahead feels no friction, by either rule") {
    BodyState state;
    state.orientation = from_roll_pitch_yaw({0.0, 0.0, 0.6});
    for (const TireModel model : {TireModel::slip, TireModel::skid}) {
        Settings settings;
        settings.tire_model = model;
        const Wrench f = friction(settings, state, {state.orientation * Vec3(20.0, 0.0, 0.0), Vec3::Zero()});
        CHECK_CLOSE(f.force.norm(), 0.0, 1e-9, "rounding");
    }
}

TEST("slip: the slope at zero is the cornering stiffness, the limit is mu N, and it grows in between") {
    Settings settings;
    double last = 0.0;
    for (int degrees = 1; degrees <= 90; ++degrees) {
        const double slip = degrees * pi / 180.0;
        const Wrench f =
            friction(settings, {}, {20.0 * Vec3(std::cos(slip), std::sin(slip), 0.0), Vec3::Zero()});
        CHECK_CLOSE(f.force.x(), 0.0, 1e-9, "a rolling wheel resists nothing along its plane");
        CHECK(-f.force.y() >= last);
        CHECK(-f.force.y() <= settings.mu_tire * 4000.0 * (1.0 + 1e-15));
        last = -f.force.y();
    }
    CHECK_CLOSE(last, settings.mu_tire * 4000.0, 1e-9, "full sliding");
    const Wrench small = friction(settings, {}, {Vec3(20.0, 20.0 * 1e-6, 0.0), Vec3::Zero()});
    CHECK_CLOSE(-small.force.y() / (4000.0 * 1e-6), settings.cornering_stiffness, 1e-3,
                "next term: slip / (3 mu) smaller");
}

TEST("skid: mu N against the velocity as soon as it leaves the heading") {
    Settings settings;
    settings.tire_model = TireModel::skid;
    const Vec3 velocity(20.0, 0.1, -3.0);
    const Wrench f = friction(settings, {}, {velocity, Vec3::Zero()});
    const Vec3 along(20.0, 0.1, 0.0);
    CHECK_CLOSE((f.force + settings.mu_tire * 4000.0 * along.normalized()).norm(), 0.0, 1e-9, "rounding");
}

TEST("friction does not turn a slow motion round") {
    // 4000 N s on 6,804 kg at mu 0.8 would take 0.47 m/s from a body that moves sideways with 1 mm/s.
    for (const TireModel model : {TireModel::slip, TireModel::skid}) {
        Settings settings;
        settings.tire_model = model;
        const Wrench f = friction(settings, {}, {Vec3(0.0, 1e-3, 0.0), Vec3::Zero()});
        CHECK(f.force.y() < 0.0);
        CHECK(1e-3 + f.force.y() / 6804.0 >= 0.0);
    }
}

TEST("without load or grip there is no friction") {
    Settings slippery;
    slippery.mu_tire = 0.0;
    const Twist sideways{Vec3(0.0, 5.0, 0.0), Vec3::Zero()};
    CHECK_CLOSE(friction(slippery, {}, sideways).force.norm(), 0.0, 0.0, "exact");
    CHECK_CLOSE(friction(Settings{}, {}, sideways, 0.0).force.norm(), 0.0, 0.0, "exact");
}
