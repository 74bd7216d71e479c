#include "kernels/friction.hpp"

#include "check.hpp"
#include "laboratory.hpp"
#include "state/block_contact.hpp"

using namespace birm3d;

namespace {

// A block of nodes at which a wall of normal -x pushes with `normal_force` on each.
struct Pressed {
    explicit Pressed(double normal_force)
        : mesh(laboratory::front_face(laboratory::w2_curve(), 8, 8)), state(mesh) {
        contact.set_normal(-Vec3::UnitX());
        contact.normal_force.fill(normal_force);
    }
    FrictionLoad friction(double mu, double full_speed, const Twist& motion, bool flat = true) const {
        FrictionLoad friction_load;
        const TrussBlockState& block = state.block[0];
        const Vec3 normal = -Vec3::UnitX();
        add_friction(mu, full_speed, motion, {block.x, block.y, block.z}, contact, flat ? &normal : nullptr,
                     friction_load);
        return friction_load;
    }

    TrussMesh mesh;
    TrussState state;
    BlockContact contact;
};

}  // namespace

TEST("full sliding: mu times the normal force against the sliding, nothing along the normal") {
    const Pressed pressed(250.0);
    const Vec3 sliding(0.0, 3.0, 4.0);
    for (const double approach : {0.0, 20.0, -5.0}) {
        const FrictionLoad f = pressed.friction(0.2, 0.1, {Vec3(approach, 0.0, 0.0) + sliding, Vec3::Zero()});
        CHECK_CLOSE((f.friction.force + 0.2 * 250.0 * 64.0 * sliding / 5.0).norm(), 0.0, 1e-9,
                    "rounding of 64 nodes");
        CHECK_CLOSE((f.friction.torque - Vec3(3.0, 0.0, 0.0).cross(f.friction.force)).norm(), 0.0, 1e-8,
                    "the nodes lie evenly about (3 m, 0, 0)");
    }
}

TEST("below the speed of full friction the force falls with the speed") {
    const Pressed pressed(250.0);
    for (const double share : {1.0, 0.5, 0.1, 0.0}) {
        const FrictionLoad f = pressed.friction(0.3, 0.2, {Vec3(0.0, 0.2 * share, 0.0), Vec3::Zero()});
        CHECK_CLOSE(f.friction.force.y(), -share * 0.3 * 250.0 * 64.0, 1e-9, "rounding of 64 nodes");
    }
}

TEST("friction takes energy out of every motion") {
    const Pressed pressed(250.0);
    for (int i = 0; i < 50; ++i) {
        const Twist motion{Vec3(std::sin(1.0 * i), std::sin(2.0 * i), std::sin(3.0 * i)),
                           Vec3(std::sin(5.0 * i), std::sin(7.0 * i), std::sin(11.0 * i))};
        const FrictionLoad f = pressed.friction(0.4, 0.05, motion);
        CHECK(f.friction.force.dot(motion.velocity) + f.friction.torque.dot(motion.angular_velocity) <= 0.0);
    }
}

TEST("resistance times the motion is the friction of nodes that slide slowly, and of no others") {
    const Pressed pressed(250.0);
    for (int i = 1; i < 20; ++i) {
        const Twist motion{0.02 * Vec3(std::sin(1.0 * i), std::sin(2.0 * i), std::sin(3.0 * i)),
                           0.02 * Vec3(std::sin(5.0 * i), std::sin(7.0 * i), std::sin(11.0 * i))};
        for (const double full_speed : {0.2, 0.02}) {
            const FrictionLoad f = pressed.friction(0.4, full_speed, motion);
            const Mat6 by_normals = pressed.friction(0.4, full_speed, motion, false).resistance;
            CHECK_CLOSE((f.resistance - by_normals).norm(), 0.0, 1e-12 * by_normals.norm(), "rounding");
            Vec6 twist, wrench;
            twist << motion.velocity, motion.angular_velocity;
            wrench << f.friction.force, f.friction.torque;
            const Mat6& of = f.resistance;
            CHECK_CLOSE((wrench + of * twist).norm(), 0.0, 1e-12 * of.norm(), "rounding");
            CHECK_CLOSE((of - of.transpose()).norm(), 0.0, 1e-12 * of.norm(), "rounding");
        }
        CHECK(pressed.friction(0.4, 1e-6, motion).resistance == Mat6::Zero());
    }
}

TEST("slow sliding that linear friction brakes follows the trapezoid rule at any step") {
    const Pressed pressed(250.0);
    const RigidBody body = laboratory::body();
    const Twist before{Vec3(0.0, 0.02, 0.01), Vec3(0.01, 0.0, -0.02)};
    const FrictionLoad f = pressed.friction(0.4, 0.2, before);
    Mat6 inertia = Mat6::Zero();
    inertia.topLeftCorner<3, 3>() = body.mass * Mat3::Identity();
    inertia.bottomRightCorner<3, 3>() = body.inertia;
    for (const double dt : {1e-4, 1e-2, 1.0}) {
        const auto half_kick = [&](const Twist& motion, const Wrench& by) -> Twist {
            return {motion.velocity + 0.5 * dt / body.mass * by.force,
                    motion.angular_velocity + 0.5 * dt * body.inverse_inertia * by.torque};
        };
        const Twist drifted = half_kick(before, f.friction);
        const Twist end =
            settled(half_kick(drifted, f.friction), before, f.resistance, dt, inertia, Mat6::Zero());
        const Twist kicked = half_kick(drifted, pressed.friction(0.4, 0.2, end).friction);
        CHECK_CLOSE((kicked.velocity - end.velocity).norm(), 0.0, 1e-13, "rounding");
        CHECK_CLOSE((kicked.angular_velocity - end.angular_velocity).norm(), 0.0, 1e-13, "rounding");
    }
}

TEST("what is held stays at rest whatever friction adds") {
    const Pressed pressed(250.0);
    const RigidBody body = laboratory::body();
    Mat6 inertia = Mat6::Zero();
    inertia.topLeftCorner<3, 3>() = body.mass * Mat3::Identity();
    inertia.bottomRightCorner<3, 3>() = body.inertia;
    Vec6 row;
    row << Vec3::UnitZ(), Vec3(0.8, -1.2, 0.0).cross(Vec3::UnitZ());
    const double stiff = 1e6 * body.mass;
    const Twist before{Vec3(0.0, 0.02, 0.01), Vec3(0.01, 0.0, -0.02)},
        motion{Vec3(0.0, 0.01, -0.03), Vec3::Zero()};
    const FrictionLoad f = pressed.friction(0.4, 0.2, before);
    const Twist end = settled(motion, before, f.resistance, 1e-2, inertia, stiff * row * row.transpose());
    const double speed = row.head<3>().dot(end.velocity) + row.tail<3>().dot(end.angular_velocity);
    CHECK_CLOSE(speed, 0.0, 0.03 * 1e-5,
                "the body's share of what holds it, 1e-6, of 0.03 m/s, and leverage");
    CHECK((end.velocity - motion.velocity).norm() > 1e-3);
}

TEST("a turn about the normal is braked by a torque alone") {
    const Pressed pressed(100.0);
    const FrictionLoad f = pressed.friction(0.5, 1e-3, {Vec3::Zero(), Vec3(2.0, 0.0, 0.0)});
    CHECK_CLOSE(f.friction.force.norm(), 0.0, 1e-9, "symmetric; rounding of 64 nodes");
    CHECK(f.friction.torque.x() < 0.0);
    CHECK_CLOSE(f.friction.torque.tail<2>().norm(), 0.0, 1e-9, "symmetric");
}

TEST("friction brings sliding to rest on the wall and never turns it round") {
    for (const double mu : {0.1, 0.5, 2.0, 10.0}) {
        Simulation simulation(laboratory::scene(laboratory::block(laboratory::w2_curve()),
                                                laboratory::wall(mu), laboratory::weightless(),
                                                80.0 * laboratory::pi / 180.0));
        double beyond_limit = 0.0, power = 0.0;
        double lost = 0.0;
        while (simulation.step()) {
            const State& state = simulation.state();
            const UnitState& unit = state.units[0];
            beyond_limit =
                std::max(beyond_limit, unit.skin.friction.force.norm() - mu * unit.skin.normal_force);
            // Energy flows one way: friction that turned a sliding round would give some back.
            power = std::min(power, state.energies.barrier_friction - lost);
            lost = state.energies.barrier_friction;
        }
        CHECK(beyond_limit <= 1e-6);
        CHECK(lost > 0.0);
        CHECK(power >= -1e-3 * lost);
    }
}
