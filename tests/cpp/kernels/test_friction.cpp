#include "birm3d/kernels/friction.hpp"

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

// A block of nodes at which a wall of normal -x presses with `pressure` each.
struct Pressed {
    explicit Pressed(double pressure)
        : mesh(laboratory::front_face(laboratory::w2_curve(), 8, 8)), state(mesh) {
        contact.set_normal(-Vec3::UnitX());
        contact.pressure.fill(pressure);
    }
    SkinForces friction(double mu, double full_speed, const Twist& motion) const {
        SkinForces forces;
        const TrussBlockState& block = state.block[0];
        add_friction(laboratory::body(), mu, full_speed, motion, {block.x, block.y, block.z}, contact,
                     forces);
        return forces;
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
        const SkinForces f = pressed.friction(0.2, 0.1, {Vec3(approach, 0.0, 0.0) + sliding, Vec3::Zero()});
        CHECK_CLOSE((f.friction.force + 0.2 * 250.0 * 64.0 * sliding / 5.0).norm(), 0.0, 1e-9,
                    "rounding of 64 nodes");
        CHECK_CLOSE((f.friction.torque - Vec3(3.0, 0.0, 0.0).cross(f.friction.force)).norm(), 0.0, 1e-8,
                    "the nodes lie evenly about (3 m, 0, 0)");
        CHECK_CLOSE(f.contact.force.norm(), 0.0, 0.0, "friction is booked apart");
        CHECK(f.friction_rate >= 0.2 * 250.0 * 64.0 / 6804.0);
    }
}

TEST("below the speed of full friction the force falls with the speed") {
    const Pressed pressed(250.0);
    for (const double share : {1.0, 0.5, 0.1, 0.0}) {
        const SkinForces f = pressed.friction(0.3, 0.2, {Vec3(0.0, 0.2 * share, 0.0), Vec3::Zero()});
        CHECK_CLOSE(f.friction.force.y(), -share * 0.3 * 250.0 * 64.0, 1e-9, "rounding of 64 nodes");
    }
}

TEST("friction takes energy out of every motion") {
    const Pressed pressed(250.0);
    for (int i = 0; i < 50; ++i) {
        const Twist motion{Vec3(std::sin(1.0 * i), std::sin(2.0 * i), std::sin(3.0 * i)),
                           Vec3(std::sin(5.0 * i), std::sin(7.0 * i), std::sin(11.0 * i))};
        const SkinForces f = pressed.friction(0.4, 0.05, motion);
        CHECK(f.friction.force.dot(motion.velocity) + f.friction.torque.dot(motion.angular_velocity) <= 0.0);
    }
}

TEST("a turn about the normal is braked by a torque alone") {
    const Pressed pressed(100.0);
    const SkinForces f = pressed.friction(0.5, 1e-3, {Vec3::Zero(), Vec3(2.0, 0.0, 0.0)});
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

namespace {

// A wheel of 0.5 m whose tread a wall of normal -s presses all around, with 100 N at each of 64 nodes.
struct Wheeled {
    Wheeled()
        : input(laboratory::front_face(laboratory::w2_curve(), 8, 8)), mesh(tread_of(input)), state(mesh) {
        contact.set_normal(-Vec3::UnitY());
        contact.pressure.fill(100.0);
    }
    static TrussMesh tread_of(TrussInput& input) {
        input.wheel_of.assign(64, -1);
        for (int i = 0; i < 64; ++i) {
            const double angle = 2.0 * laboratory::pi * i / 64.0;
            input.node.push_back(center + 0.5 * Vec3(std::cos(angle), 0.0, std::sin(angle)));
            input.anchor.push_back(input.node.back() - 0.4 * Vec3::UnitY());
            input.curve_of.push_back(0);
            input.scale.push_back(0.01);
            input.wheel_of.push_back(1);
        }
        return TrussMesh(input, {{Vec3::Zero(), 0.3}, {center, 0.5}});
    }
    // Of the nodes for which `here` holds.
    template <class Here>
    Wrench friction(bool rolls, const Twist& motion, const Here& here) {
        SkinForces forces;
        const TrussBlockState& block = state.block[1];
        BlockContact part = contact;
        for (std::size_t i = 0; i < lanes; ++i)
            if (!here(Vec3(block.x[i], block.y[i], block.z[i]) - center)) part.pressure[i] = 0.0;
        add_tread_friction(laboratory::body(), 0.5, 1e-3, motion, mesh.tread[0], rolls,
                           {block.x, block.y, block.z}, part, forces);
        return forces.friction;
    }

    static inline const Vec3 center{2.0, 0.9, -0.6};
    TrussInput input;
    TrussMesh mesh;
    TrussState state;
    BlockContact contact;
};

const auto everywhere = [](const Vec3&) { return true; };

}  // namespace

TEST("a tread that rolls rests on the ground below and goes down in front: it is lifted there") {
    Wheeled wheel;
    const Twist ahead{Vec3(20.0, 0.0, 0.0), Vec3::Zero()};
    const auto lowest = [](const Vec3& d) { return d.z() < -0.4999; };
    CHECK_CLOSE(wheel.friction(true, ahead, lowest).force.norm(), 0.0, 1e-9, "rounding: no sliding there");
    const auto highest = [](const Vec3& d) { return d.z() > 0.4999; };
    CHECK_CLOSE((wheel.friction(true, ahead, highest).force + Vec3(50.0, 0.0, 0.0)).norm(), 0.0, 1e-9,
                "it slides with twice the speed; rounding");
    // In front the tread goes ahead and down at 45 degrees.
    const auto foremost = [](const Vec3& d) { return d.x() > 0.4999; };
    const Vec3 lifted(-50.0 * std::sqrt(0.5), 0.0, 50.0 * std::sqrt(0.5));
    CHECK_CLOSE((wheel.friction(true, ahead, foremost).force - lifted).norm(), 0.0, 1e-9, "rounding");
    const Twist back{Vec3(-20.0, 0.0, 0.0), Vec3::Zero()};
    CHECK_CLOSE((wheel.friction(true, back, foremost).force + lifted).norm(), 0.0, 1e-9, "rounding");
}

TEST("a locked wheel slides with the body") {
    Wheeled wheel;
    const Twist motion{Vec3(20.0, 1.0, -3.0), Vec3(0.4, -0.3, 0.2)};
    SkinForces forces;
    const TrussBlockState& block = wheel.state.block[1];
    add_friction(laboratory::body(), 0.5, 1e-3, motion, {block.x, block.y, block.z}, wheel.contact, forces);
    const Wrench locked = wheel.friction(false, motion, everywhere);
    CHECK_CLOSE((locked.force - forces.friction.force).norm(), 0.0, 0.0, "exact");
    CHECK_CLOSE((locked.torque - forces.friction.torque).norm(), 0.0, 0.0, "exact");
}

TEST("the tread turns with the body's speed at its own axle") {
    // A turn about the wheel's axle leaves the axle at rest: the tread moves as the body does.
    Wheeled wheel;
    const Vec3 w(0.0, 3.0, 0.0);
    const Twist about_axle{-w.cross(Wheeled::center), w};
    CHECK_CLOSE((wheel.friction(true, about_axle, everywhere).torque -
                 wheel.friction(false, about_axle, everywhere).torque)
                    .norm(),
                0.0, 1e-9, "rounding");
    // About the mass centre the axle, 0.6 m below it, goes back with 1.8 m/s: the tread turns backwards.
    const Twist about_center{Vec3::Zero(), w};
    const auto lowest = [](const Vec3& d) { return d.z() < -0.4999; };
    // The lowest point: the body's -3 * 1.1 m/s and the tread's 1.8 leave -1.5 m/s; the axle goes down.
    const Vec3 slides(-1.5, 0.0, -6.0);
    CHECK_CLOSE((wheel.friction(true, about_center, lowest).force + 50.0 * slides.normalized()).norm(), 0.0,
                1e-9, "rounding");
}
