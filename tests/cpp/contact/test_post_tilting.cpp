// Posts that yield: a rigid, perfectly plastic hinge at the foot.
#include "contact/post_tilting.hpp"

#include <array>

#include "check.hpp"
#include "kernels/impulse.hpp"
#include "kernels/integrate.hpp"
#include "laboratory.hpp"
#include "scene/bodies.hpp"

using namespace laboratory;

namespace {

constexpr double height = 1.0, radius = 0.15;
constexpr YieldingPosts tube{.mass = 100.0, .inertia = 40.0, .plastic_moment = 2e5};

Barrier row_of_posts(int count, const YieldingPosts& yielding) {
    std::vector<Element> elements;
    for (int i = 0; i < count; ++i)
        elements.push_back({Post(radius, height), Vec3(0.0, 1.2 * (i - 0.5 * (count - 1)), 0.0)});
    return {std::move(elements), 0.0, Vec3::Zero(), 0.0, {}, yielding};
}

// The front of W2 stands from the ground up; the vehicle has no wheels and no weight.
Scene scene_at(const Barrier& barrier, double speed, double tolerance) {
    return {block(w2_curve(), 20, 10, {}, 0.9), std::make_shared<const Barrier>(barrier),
            Approach{.speed = speed, .angle = pi / 2.0}, weightless(tolerance), 0.4};
}

Scene at_posts(int count, const YieldingPosts& yielding, double speed, double tolerance) {
    return scene_at(row_of_posts(count, yielding), speed, tolerance);
}

}  // namespace

TEST("a post that spins comes to rest after I w^2 / 2M") {
    const MovingElement post = tilting_post(Post(radius, height), tube);
    const double spin = 30.0;  // rad/s
    const double angle = tube.inertia * spin * spin / (2.0 * tube.plastic_moment);
    for (const double dt : {1e-4, 1e-5}) {
        BodyState body;
        body.angular_momentum = Vec3(0.0, tube.inertia * spin, 0.0);
        const auto resist = [&] {
            body.angular_momentum += plastic_impulse(post, body, body.angular_momentum, 0.5 * dt);
        };
        while (!body.angular_momentum.isZero(0.0)) {
            resist();
            drift(post.body, dt, body);
            resist();
        }
        // Within the last step the moment is too large by an unknown part of it.
        CHECK_CLOSE(tilt_of(body), angle, spin * dt * dt * tube.plastic_moment / tube.inertia,
                    "the last step");
        CHECK_CLOSE(body.orientation.z(), 0.0, 1e-15, "rounding: it does not turn about its axis");
    }
}

TEST(
    "a moment below the plastic one does not move a post, and one that lies on the ground turns no further") {
    const MovingElement post = tilting_post(Post(radius, height), tube);
    const double dt = 1e-3;
    const Vec3 below(0.0, 0.999 * dt * tube.plastic_moment, 0.0), above = 2.0 * below;
    BodyState body;
    CHECK((below + plastic_impulse(post, body, below, dt)).isZero(0.0));
    CHECK((above + plastic_impulse(post, body, above, dt)).norm() > 0.9 * dt * tube.plastic_moment);
    body.orientation = Eigen::AngleAxisd(post.lying_tilt, Vec3::UnitX());
    CHECK((above + plastic_impulse(post, body, above, dt)).isZero(0.0));
}

TEST("an impact on a post is Eq. 1 with the post's effective mass I / h^2") {
    const double mass = 2000.0, speed = 5.0, h = 0.7, restitution = 0.3;
    for (const double tilt : {0.0, 0.6}) {
        const Vec3 axis(std::sin(tilt), 0.0, std::cos(tilt));
        ContactBody vehicle{1.0 / mass, Mat3::Zero(), {Vec3(speed, 0.0, 0.0), Vec3::Zero()}};
        ContactBody post{0.0, (Mat3::Identity() - axis * axis.transpose()) / tube.inertia, {}, Freedom::tilt};
        std::array<ContactBody, 2> bodies{vehicle, post};
        RigidContact contact;
        contact.body = 0, contact.other = 1;
        contact.normal = Vec3(-std::cos(tilt), 0.0, std::sin(tilt));
        contact.other_arm = h * axis;
        const double approach = speed * std::cos(tilt);
        contact.target = restitution * approach;
        const double effective = 1.0 / (1.0 / mass + h * h / tube.inertia);
        solve_impulses({&contact, 1}, bodies, speed);
        CHECK_CLOSE(contact.impulse, (1.0 + restitution) * approach * effective, 1e-6 * mass * speed,
                    "compliance of the solver");
        CHECK_CLOSE(bodies[1].motion.angular_velocity.y(), contact.impulse * h / tube.inertia, 1e-9,
                    "rounding");
    }
}

TEST("energies balance, a post does not spring back, and its work is moment times angle") {
    const double kinetic = 0.5 * body().mass * 8.0 * 8.0;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        Simulation run(at_posts(1, tube, 8.0, tolerance));
        double tilt = 0.0, yielding = 0.0;
        while (run.state().time < 0.4) {
            run.step();
            const State& now = run.state();
            CHECK(tilt_of(now.moving_elements[0]) >= tilt);
            CHECK(now.energies.yielding >= yielding);
            tilt = tilt_of(now.moving_elements[0]);
            yielding = now.energies.yielding;
        }
        CHECK(tilt > 0.1);
        CHECK_CLOSE(yielding, tube.plastic_moment * tilt, 1e-3 * yielding,
                    "works and angles are sums over steps of a millisecond");
        const double error = std::abs(run.state().energies.total() - kinetic) / kinetic;
        CHECK(error < (tolerance > 1e-4 ? 3e-4 : 3e-5));
    }
}

TEST("energies balance where the rigid core meets posts") {
    const double kinetic = 0.5 * body().mass * 15.0 * 15.0;
    for (const double tolerance : {1e-2, 1e-4}) {
        Simulation run(at_posts(2, tube, 15.0, tolerance));
        laboratory::run(run);
        CHECK(run.state().energies.impacts > 0.1 * kinetic);
        CHECK_CLOSE(run.state().energies.total(), kinetic, 3e-4 * kinetic, "error of the steps");
        CHECK(run.state().balances.falls[index_of(&Energies::yielding)].size == 0.0);
    }
}

TEST("posts whose moment nothing exceeds are rigid posts, where the core meets none") {
    YieldingPosts strong = tube;
    strong.plastic_moment = 1e12;
    Simulation yields(at_posts(3, strong, 8.0, 1e-4));
    const Barrier fixed(row_of_posts(3, strong).elements, 0.0, Vec3::Zero(), 0.0);
    Simulation rigid(scene_at(fixed, 8.0, 1e-4));
    laboratory::run(yields);
    laboratory::run(rigid);
    const State &one = yields.state(), &other = rigid.state();
    CHECK(one.moving_elements[1].orientation.coeffs() == Quat::Identity().coeffs());
    CHECK_CLOSE(one.energies.crushed, other.energies.crushed, 1e-4 * other.energies.crushed, "other steps");
    CHECK_CLOSE(one.units[0].body.velocity.x(), other.units[0].body.velocity.x(), 8e-4, "other steps");
}

TEST("what can not yield is refused") {
    CHECK_THROWS(tilting_post(Post(radius, infinity), tube), std::invalid_argument);
    YieldingPosts weightless_post = tube;
    weightless_post.inertia = 0.0;
    CHECK_THROWS(tilting_post(Post(radius, height), weightless_post), std::invalid_argument);
    const Element wall{HalfSpace{}, Vec3::Zero()};
    CHECK_THROWS(Barrier({wall}, 0.0, Vec3::Zero(), 0.0, {}, tube), std::invalid_argument);
    CHECK_THROWS(
        Barrier({{Post(radius, height), Vec3::Zero()}}, 0.0, Vec3::Zero(), 0.0, FreeStanding{}, tube),
        std::invalid_argument);
}
