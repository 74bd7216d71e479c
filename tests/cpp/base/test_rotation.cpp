#include "birm3d/base/rotation.hpp"

#include <numbers>

#include "check.hpp"

using namespace birm3d;

namespace {

constexpr double pi = std::numbers::pi;

double difference(const Quat& a, const Quat& b) {
    return (a.toRotationMatrix() - b.toRotationMatrix()).norm();
}

}  // namespace

TEST("roll, pitch and yaw survive the way to a quaternion and back") {
    for (double roll = -3.0; roll <= 3.0; roll += 0.75) {
        for (double pitch = -1.5; pitch <= 1.5; pitch += 0.5) {
            for (double yaw = -3.0; yaw <= 3.0; yaw += 0.75) {
                const Angles back = roll_pitch_yaw(from_roll_pitch_yaw({roll, pitch, yaw}));
                CHECK_CLOSE(back.roll, roll, 1e-13, "rounding, 1/cos(1.5) = 14 times enlarged");
                CHECK_CLOSE(back.pitch, pitch, 1e-13, "the same: asin near its end");
                CHECK_CLOSE(back.yaw, yaw, 1e-13, "the same");
            }
        }
    }
}

TEST("at a pitch of 90 degrees the orientation survives, if not the split into roll and yaw") {
    for (const double pitch : {0.5 * pi, -0.5 * pi}) {
        const Quat q = from_roll_pitch_yaw({0.3, pitch, 0.7});
        CHECK(std::isfinite(roll_pitch_yaw(q).roll));
        CHECK_CLOSE(std::abs(roll_pitch_yaw(q).pitch), 0.5 * pi, 1e-7, "asin: root of the rounding");
    }
}

TEST("the signs are those of ISO 8855") {
    const Vec3 r = Vec3::UnitX(), s = Vec3::UnitY();
    CHECK_CLOSE((from_roll_pitch_yaw({0.0, 0.0, 0.5 * pi}) * r).y(), 1.0, 1e-15,
                "positive yaw turns to the left");
    CHECK_CLOSE((from_roll_pitch_yaw({0.0, 0.5 * pi, 0.0}) * r).z(), -1.0, 1e-15,
                "positive pitch: nose down");
    CHECK_CLOSE((from_roll_pitch_yaw({0.5 * pi, 0.0, 0.0}) * s).z(), 1.0, 1e-15,
                "positive roll: left side up");
}

TEST("the order is yaw, then pitch, then roll") {
    const double yaw = 0.4, pitch = 0.3;
    const Vec3 nose = from_roll_pitch_yaw({1.2, pitch, yaw}) * Vec3::UnitX();
    CHECK_CLOSE(nose.x(), std::cos(yaw) * std::cos(pitch), 1e-15, "rounding");
    CHECK_CLOSE(nose.y(), std::sin(yaw) * std::cos(pitch), 1e-15, "rounding");
    CHECK_CLOSE(nose.z(), -std::sin(pitch), 1e-15, "rounding");
}

TEST("the Cayley map is a rotation that departs from the exponential map in third order") {
    const Quat q = from_roll_pitch_yaw({0.2, -0.4, 1.1});
    const Vec3 axis = Vec3(1.0, -2.0, 0.5).normalized();
    const auto departure = [&](double angle) {
        return difference(cayley(q, angle * axis), q * Quat(Eigen::AngleAxisd(angle, axis)));
    };
    CHECK_CLOSE(cayley(q, 0.7 * axis).norm(), 1.0, 1e-15, "rounding");
    CHECK_CLOSE(departure(0.0), 0.0, 1e-15, "rounding");
    CHECK_CLOSE(departure(0.1) / departure(0.05), 8.0, 0.05, "next term is of fifth order");
    // Its angle is 2 atan(angle / 2).
    CHECK_CLOSE(difference(cayley(q, 0.7 * axis), q * Quat(Eigen::AngleAxisd(2.0 * std::atan(0.35), axis))),
                0.0, 1e-15, "rounding");
}
