#include "kernels/ground_slide.hpp"

#include <random>

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

const RigidBody body(2000.0, Vec3(1600.0, 200.0, 1550.0).asDiagonal());

std::array<Vec3, 4> corners(double turn) {
    const Mat3 R = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
    return {R * Vec3(-0.3, -1.5, -0.4), R * Vec3(0.3, -1.5, -0.4), R * Vec3(-0.3, 1.5, -0.4),
            R * Vec3(0.3, 1.5, -0.4)};
}

Vec3 at_corner(const Twist& motion, const Vec3& arm) {
    const Vec3 u = motion.velocity + motion.angular_velocity.cross(arm);
    return {u.x(), u.y(), 0.0};
}

Twist after(const Twist& motion, const Wrench& friction) {
    return {motion.velocity + body.inverse_mass * friction.force,
            motion.angular_velocity + body.inverse_inertia * friction.torque};
}

double energy(const Twist& motion) {
    return 0.5 * body.mass * motion.velocity.squaredNorm() +
           0.5 * motion.angular_velocity.dot(body.inertia * motion.angular_velocity);
}

}  // namespace

TEST("a straight slide loses the limit, and stops when that would reverse it") {
    const Twist motion{Vec3(3.0, 4.0, 0.0), Vec3::Zero()};
    const Wrench friction = slide_friction(body, corners(0.3), 500.0, motion);
    CHECK_CLOSE(friction.force.norm(), 500.0, 1e-12 * 500.0, "rounding");
    CHECK_CLOSE(friction.force.dot(motion.velocity), -2500.0, 1e-9, "rounding");
    CHECK_CLOSE(friction.torque.norm(), 0.0, 0.0, "corners that slide alike turn nothing");
    const Twist rest = after(motion, slide_friction(body, corners(0.3), 2e4, motion));
    CHECK_CLOSE(rest.velocity.norm(), 0.0, 1e-15, "rounding");
}

TEST("friction is the limit against the sliding at corners that slide") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    int sliding = 0;
    for (int i = 0; i < 300; ++i) {
        const Twist motion{5.0 * Vec3(any(random), any(random), 0.0), 3.0 * Vec3(0.0, 0.0, any(random))};
        const std::array<Vec3, 4> arm = corners(any(random));
        const double limit = 3000.0 * (1.0 + any(random));
        const Wrench friction = slide_friction(body, arm, limit, motion);
        const Twist left = after(motion, friction);
        CHECK(energy(left) <= energy(motion));
        bool all_slide = true;
        Wrench expected;
        for (const Vec3& r : arm) {
            const Vec3 u = at_corner(left, r);
            all_slide = all_slide && u.norm() > 0.1;
            const Vec3 push = -0.25 * limit * u.normalized();
            expected += {push, Vec3(0.0, 0.0, r.cross(push).z())};
        }
        if (!all_slide) continue;
        ++sliding;
        CHECK_CLOSE((friction.force - expected.force).norm(), 0.0, 1e-8 * limit, "rounding off of corners");
        CHECK_CLOSE((friction.torque - expected.torque).norm(), 0.0, 1e-8 * limit, "the same");
    }
    CHECK(sliding > 100);
}

TEST("what is left of a motion is the least of the convex function, held or not") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    int held = 0;
    for (int i = 0; i < 200; ++i) {
        const Twist motion{Vec3(any(random), any(random), 0.0), Vec3(0.0, 0.0, any(random))};
        const std::array<Vec3, 4> arm = corners(any(random));
        const double limit = 1500.0 * (1.0 + any(random));
        const auto value = [&](const Twist& t) {
            double sum = energy({t.velocity - motion.velocity, t.angular_velocity - motion.angular_velocity});
            for (const Vec3& r : arm)
                sum += 0.25 * limit * at_corner(t, r).norm();
            return sum;
        };
        const Twist left = after(motion, slide_friction(body, arm, limit, motion));
        if (left.velocity.norm() < 1e-12 && left.angular_velocity.norm() < 1e-12) ++held;
        const double least = value(left);
        for (int k = 0; k < 50; ++k) {
            const double size = std::pow(10.0, -4.0 * (k % 5) / 4.0);
            const Twist other{left.velocity + size * Vec3(any(random), any(random), 0.0),
                              left.angular_velocity + size * Vec3(0.0, 0.0, any(random))};
            // Held slabs are taken to rest where a ten-thousandth of the limit is missing.
            CHECK(value(other) >= least - 1e-4 * limit * body.inverse_mass * limit);
        }
    }
    CHECK(held > 20);
}

TEST("without load or motion there is no friction") {
    const Twist motion{Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.5)};
    CHECK(slide_friction(body, corners(0.0), 0.0, motion).force.isZero(0.0));
    CHECK(slide_friction(body, corners(0.0), 10.0, {}).force.isZero(0.0));
}
