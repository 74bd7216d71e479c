#include "birm3d/kernels/ground_slide.hpp"

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

namespace {

// Slabs end to end along y, pinned at their ends, all with one limit.
struct Row {
    explicit Row(std::size_t count, double limit) {
        for (std::size_t i = 0; i < count; ++i)
            slabs.push_back({&body, corners(0.0), limit, {}, {}});
        for (std::size_t i = 1; i < count; ++i)
            for (const Vec3& n : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())}) {
                const Vec3 a(0.0, 1.5, 0.0), b(0.0, -1.5, 0.0);
                pins.push_back({i - 1, i, Vec3(n.x(), n.y(), a.cross(n).z()),
                                Vec3(-n.x(), -n.y(), -b.cross(n).z()), 0.0});
            }
    }
    std::vector<PinnedSlab> slabs;
    std::vector<SlabPin> pins;
};

}  // namespace

TEST("a pinned row that slides as one loses the limit of each") {
    Row row(4, 300.0);
    for (PinnedSlab& slab : row.slabs)
        slab.motion.velocity = {3.0, -4.0, 0.0};
    for (const Wrench& friction : slide_friction(row.slabs, row.pins, false)) {
        CHECK_CLOSE((friction.force - 300.0 * Vec3(-0.6, 0.8, 0.0)).norm(), 0.0, 1e-9 * 300.0, "rounding");
        CHECK_CLOSE(friction.torque.norm(), 0.0, 1e-9 * 300.0, "rounding");
    }
}

TEST("a row that is pulled at one slab along its length holds it together, from a guess or without") {
    Row row(7, 100.0);
    row.slabs[2].motion.velocity = {0.0, 250.0 * body.inverse_mass, 0.0};
    // What friction can take is 5 cm/s, the rounding off a millionth of it.
    for (const bool guessed : {false, true})
        for (const Wrench& friction : slide_friction(row.slabs, row.pins, guessed)) {
            CHECK_CLOSE(friction.force.y(), -250.0 / 7.0, 1e-3, "each an equal share, to the rounding off");
            CHECK_CLOSE(friction.force.x(), 0.0, 1e-3, "the same");
            CHECK_CLOSE(friction.torque.z(), 0.0, 1e-3, "the same");
        }
}

TEST("a row that is pushed aside bends at its pins: the slab that is pushed slides, its ends drag the next") {
    Row row(7, 100.0);
    row.slabs[3].motion.velocity = {1.0, 0.0, 0.0};
    const std::vector<Wrench> friction = slide_friction(row.slabs, row.pins, false);
    CHECK_CLOSE(friction[3].force.x(), -100.0, 1e-6 * 100.0, "full, against the push");
    CHECK(friction[2].force.norm() <= 100.0 * (1.0 + 1e-12));
    CHECK(friction[2].torque.z() * friction[4].torque.z() < 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK_CLOSE(friction[i].force.x(), friction[6 - i].force.x(), 1e-6 * 100.0, "left and right");
        CHECK_CLOSE(friction[i].force.y(), -friction[6 - i].force.y(), 1e-6 * 100.0, "left and right");
        CHECK_CLOSE(friction[i].torque.z(), -friction[6 - i].torque.z(), 1e-6 * 100.0, "left and right");
    }
}

TEST("without friction a row has none") {
    Row row(3, 0.0);
    row.slabs[0].motion.velocity = {1.0, 0.0, 0.0};
    for (const Wrench& friction : slide_friction(row.slabs, row.pins, false))
        CHECK(friction.force.isZero(0.0));
}
