#include "kernels/friction_tire.hpp"

#include <vector>

#include "check.hpp"
#include "kernels/friction.hpp"
#include "laboratory.hpp"
#include "state/block_contact.hpp"

using namespace birm3d;

namespace {

constexpr double mu = 0.5, full_speed = 1e-3, radius = 0.4;
const Vec3 axle(1.5, 0.9, -0.5);

// A node of the tread at an angle from the front upwards; a barrier of that normal pushes it with that force.
TireNodeContact at(double angle, const Twist& motion, double force = 100.0,
                   const Vec3& normal = -Vec3::UnitY()) {
    const Vec3 d = radius * Vec3(std::cos(angle), 0.0, std::sin(angle));
    return tire_node_contact({d.z() / radius, -d.x() / radius, 0}, 0, motion, axle + d, normal, force);
}

Wrench friction(const std::vector<TireNodeContact>& wheel, double rolling) {
    FrictionLoad friction_load;
    for (const TireNodeContact& node : wheel)
        add_tire_node_friction(mu, full_speed, rolling, node, friction_load);
    return friction_load.friction;
}

// About the wheel's axle.
double torque_of(const Wrench& w) {
    return (w.torque - axle.cross(w.force)).y();
}

const Twist ahead{Vec3(20.0, 0.0, 0.0), Vec3::Zero()};
constexpr double degree = laboratory::pi / 180.0;

}  // namespace

TEST("a wheel met below and ahead of its axle is pushed up and back, along the spoke") {
    const std::vector<TireNodeContact> wheel = {at(-45.0 * degree, ahead)};
    const double q = free_rolling_speed(full_speed, wheel);
    CHECK_CLOSE(q, 20.0 * std::sqrt(0.5), 1e-12, "the tread moves with the body's part across the spoke");
    const Vec3 pushed(-50.0 * std::sqrt(0.5), 0.0, 50.0 * std::sqrt(0.5));
    CHECK_CLOSE((friction(wheel, q).force - pushed).norm(), 0.0, 1e-9, "rounding");
}

TEST("a wheel met at its lowest point rolls there: no friction but on what slides sideways") {
    const std::vector<TireNodeContact> wheel = {at(-90.0 * degree, ahead, 100.0, Vec3::UnitZ())};
    const double q = free_rolling_speed(full_speed, wheel);
    CHECK_CLOSE(q, 20.0, 1e-12, "as on the road");
    CHECK_CLOSE(friction(wheel, q).force.norm(), 0.0, 1e-9, "rounding");
}

TEST("friction has no torque about the axle of a wheel that is free, and takes energy out of the body") {
    for (int i = 0; i < 60; ++i) {
        const Twist motion{Vec3(20.0 * std::cos(1.0 * i), std::sin(2.0 * i), 5.0 * std::sin(3.0 * i)),
                           Vec3(std::sin(5.0 * i), std::sin(7.0 * i), std::sin(11.0 * i))};
        const Vec3 normal = Vec3(0.2 * std::sin(1.0 * i), -1.0, 0.5 * std::cos(4.0 * i)).normalized();
        std::vector<TireNodeContact> wheel;
        double pressed = 0.0;
        for (int node = 0; node < 2 + i % 9; ++node) {
            const double force = 50.0 + 40.0 * std::sin(13.0 * (i + node));
            wheel.push_back(at(0.7 * i + 0.4 * node, motion, force, normal));
            pressed += force;
        }
        const double q = free_rolling_speed(full_speed, wheel);
        const Wrench f = friction(wheel, q);
        CHECK_CLOSE(torque_of(f) / (mu * pressed * radius), 0.0, 1e-9,
                    "q to rounding, over the slope of friction below the full speed");
        const double power = f.force.dot(motion.velocity) + f.torque.dot(motion.angular_velocity);
        double heat = 0.0;
        for (const TireNodeContact& node : wheel) {
            const Vec3 u = node.sliding + q * node.rolling;
            heat += mu * node.normal_force * u.squaredNorm() / std::max(u.norm(), full_speed);
        }
        CHECK_CLOSE(power / heat, -1.0, 1e-9, "the wheel gives and takes none; rounding as above");
        CHECK(f.force.norm() <= mu * pressed * (1.0 + 1e-14));
    }
}

TEST("left and right wheels mirror each other") {
    // Left and right: nodes of the mirrored wheel, normals mirrored, the body's motion mirrored.
    const Twist motion{Vec3(15.0, 3.0, -2.0), Vec3(0.3, 0.2, -0.4)};
    const Twist mirrored{Vec3(15.0, -3.0, -2.0), Vec3(-0.3, 0.2, 0.4)};
    const Vec3 mirror(1.0, -1.0, 1.0);
    std::vector<TireNodeContact> right, left;
    for (const double angle : {-80.0, -50.0, -20.0, 10.0}) {
        const Vec3 d = radius * Vec3(std::cos(angle * degree), 0.0, std::sin(angle * degree));
        const TireNode node{d.z() / radius, -d.x() / radius, 0};
        const Vec3 normal = Vec3(0.1, -1.0, 0.4).normalized();
        right.push_back(tire_node_contact(node, 0, motion, axle + d, normal, 80.0));
        left.push_back(tire_node_contact(node, 0, mirrored, (axle + d).cwiseProduct(mirror),
                                         normal.cwiseProduct(mirror), 80.0));
    }
    const double q = free_rolling_speed(full_speed, right);
    CHECK_CLOSE(free_rolling_speed(full_speed, left), q, 1e-12, "rounding");
    const Wrench a = friction(right, q), b = friction(left, q);
    CHECK_CLOSE((b.force - a.force.cwiseProduct(mirror)).norm(), 0.0, 1e-10, "rounding");
    CHECK_CLOSE((b.torque + a.torque.cwiseProduct(mirror)).norm(), 0.0, 1e-10, "rounding");
}

TEST("a locked wheel slides with the body") {
    const Twist motion{Vec3(20.0, 1.0, -3.0), Vec3(0.4, -0.3, 0.2)};
    const TireNodeContact node = at(-30.0 * degree, motion);
    BlockContact contact;
    contact.set_normal(-Vec3::UnitY());
    contact.normal_force.fill(0.0);
    contact.normal_force[0] = node.normal_force;
    BlockColumn x{}, y{}, z{};
    x[0] = node.arm.x(), y[0] = node.arm.y(), z[0] = node.arm.z();
    FrictionLoad skin, tread;
    add_friction(mu, full_speed, motion, {x, y, z}, contact, nullptr, skin);
    add_tire_node_friction(mu, full_speed, 0.0, node, tread);
    CHECK_CLOSE((skin.friction.force - tread.friction.force).norm(), 0.0, 1e-12, "rounding");
    CHECK_CLOSE((skin.friction.torque - tread.friction.torque).norm(), 0.0, 1e-12, "rounding");
    CHECK_CLOSE((skin.resistance - tread.resistance).norm(), 0.0, 1e-12, "rounding");
}

TEST("nodes that nothing presses leave a wheel alone") {
    CHECK(free_rolling_speed(full_speed, {}) == 0.0);
    const std::vector<TireNodeContact> wheel = {at(0.3, ahead, 0.0)};
    CHECK(free_rolling_speed(full_speed, wheel) == 0.0);
    CHECK(friction(wheel, 3.0).force.norm() == 0.0);
}
