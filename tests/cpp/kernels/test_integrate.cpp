#include "kernels/integrate.hpp"

#include <cmath>

#include "birm3d/base/rotation.hpp"
#include "check.hpp"

using namespace birm3d;

namespace {

// Kick, drift, kick with a constant force.
void step(const RigidBody& body, const Vec3& force, double dt, BodyState& state) {
    kick(body, {0.5 * dt * force, Vec3::Zero()}, state);
    drift(body, dt, state);
    kick(body, {0.5 * dt * force, Vec3::Zero()}, state);
}

}  // namespace

TEST("a falling body follows its parabola") {
    const RigidBody body(800.0, Vec3(200.0, 300.0, 400.0).asDiagonal());
    const Vec3 gravity(0.0, 0.0, -9.80665);
    BodyState state;
    state.position = {1.0, 2.0, 50.0};
    state.velocity = {3.0, 0.0, 4.0};
    const int steps = 1000;
    const double dt = 2e-3, t = steps * dt;
    for (int i = 0; i < steps; ++i)
        step(body, body.mass * gravity, dt, state);
    const Vec3 exact = Vec3(1.0, 2.0, 50.0) + t * Vec3(3.0, 0.0, 4.0) + 0.5 * t * t * gravity;
    CHECK_CLOSE((state.position - exact).norm(), 0.0, 1e-11,
                "leapfrog is exact for a constant force: rounding of 1000 steps");
    CHECK_CLOSE((state.velocity - Vec3(3.0, 0.0, 4.0) - t * gravity).norm(), 0.0, 1e-11, "the same");
}

TEST("a tumbling body keeps its angular momentum and its energy for ever") {
    // Spun about the middle axis, where the motion is unstable and turns over again and again.
    const RigidBody body(1.0, Vec3(1.0, 2.0, 3.0).asDiagonal());
    BodyState state;
    state.angular_momentum = {0.01, 10.0, 0.01};
    const Vec3 L = state.angular_momentum;
    const double energy = kinetic_energy(body, state);
    double most = 0.0;
    bool turned_over = false;
    for (int i = 0; i < 20000; ++i) {
        drift(body, 1e-3, state);
        most = std::max(most, std::abs(kinetic_energy(body, state) / energy - 1.0));
        turned_over = turned_over || (state.orientation.conjugate() * L).y() < -9.0;
    }
    CHECK(state.angular_momentum == L);
    CHECK(turned_over);
    CHECK_CLOSE(most, 0.0, 1e-12, "the midpoint rule keeps it; rounding of 20000 steps");
    CHECK_CLOSE(state.orientation.norm(), 1.0, 1e-14, "rounding");
}

TEST("a symmetric top precesses as the text book says, in second order of the step") {
    // Torque-free: the axis turns about L with L/I1.
    const double I1 = 2.0, I3 = 3.0, t = 1.0;
    const RigidBody body(1.0, Vec3(I1, I1, I3).asDiagonal());
    const auto error = [&](int steps) {
        BodyState state;
        state.orientation = from_roll_pitch_yaw({0.5, 0.0, 0.0});
        state.angular_momentum = {0.0, 0.0, 4.0};
        const Vec3 axis = state.orientation * Vec3::UnitZ();
        for (int i = 0; i < steps; ++i)
            drift(body, t / steps, state);
        const Vec3 exact = Eigen::AngleAxisd(4.0 / I1 * t, Vec3::UnitZ()) * axis;
        return (state.orientation * Vec3::UnitZ() - exact).norm();
    };
    CHECK(error(200) < 1e-4);
    CHECK_CLOSE(error(100) / error(200), 4.0, 0.05, "second order; the next term is of fourth");
}

TEST("time runs back") {
    const RigidBody body(1.0, Vec3(1.0, 2.0, 2.5).asDiagonal());
    BodyState state;
    state.velocity = {1.0, 2.0, 3.0};
    state.angular_momentum = {1.0, -2.0, 0.5};
    for (int i = 0; i < 500; ++i)
        drift(body, 0.01, state);
    for (int i = 0; i < 500; ++i)
        drift(body, -0.01, state);
    CHECK_CLOSE(state.position.norm(), 0.0, 1e-12, "rounding of 1000 steps");
    CHECK_CLOSE(state.orientation.angularDistance(Quat::Identity()), 0.0, 1e-6,
                "an angle from a cosine: root of the rounding");
}

TEST("angular velocity, inverse inertia and energy agree with each other") {
    const RigidBody body(7.0, Vec3(1.0, 2.0, 2.5).asDiagonal());
    BodyState state;
    state.orientation = from_roll_pitch_yaw({0.3, -0.8, 2.0});
    state.velocity = {1.0, 2.0, 3.0};
    state.angular_momentum = {1.0, -2.0, 0.5};
    const Vec3 w = angular_velocity(body, state);
    CHECK_CLOSE((inverse_inertia_in_world(body, state) * state.angular_momentum - w).norm(), 0.0, 1e-15,
                "rounding");
    CHECK(twist(body, state).velocity == state.velocity);
    CHECK(twist(body, state).angular_velocity == w);
    CHECK_CLOSE(kinetic_energy(body, state), 0.5 * 7.0 * 14.0 + 0.5 * w.dot(state.angular_momentum), 1e-14,
                "rounding");
}
