#include "kernels/integrate.hpp"

#include "birm3d/base/rotation.hpp"

namespace birm3d {

Mat3 inverse_inertia_in_world(const RigidBody& body, const BodyState& state) {
    const Mat3 R = state.orientation.toRotationMatrix();
    return R * body.inverse_inertia * R.transpose();
}

Vec3 angular_velocity(const RigidBody& body, const BodyState& state) {
    const Mat3 R = state.orientation.toRotationMatrix();
    return R * (body.inverse_inertia * (R.transpose() * state.angular_momentum));
}

Twist twist(const RigidBody& body, const BodyState& state) {
    return {state.velocity, angular_velocity(body, state)};
}

Twist twist_in_body_axes(const RigidBody& body, const BodyState& state) {
    const Mat3 R = state.orientation.toRotationMatrix();
    return {R.transpose() * state.velocity, R.transpose() * angular_velocity(body, state)};
}

void kick(const RigidBody& body, const Wrench& impulse, BodyState& state) {
    state.velocity += body.inverse_mass * impulse.force;
    state.angular_momentum += impulse.torque;
}

void drift(const RigidBody& body, double dt, BodyState& state) {
    state.position += dt * state.velocity;

    const Vec3& L = state.angular_momentum;
    if (L.isZero(0.0)) return;
    const Quat q0 = state.orientation;
    const Vec3 P0 = q0.conjugate() * L;
    Vec3 P1 = P0;
    // Each iteration reduces the error by about dt * |omega| / 2. Steps of useful length never reach the bound.
    constexpr int most_iterations = 100;
    for (int i = 0; i < most_iterations; ++i) {
        state.orientation = cayley(q0, dt * (body.inverse_inertia * (0.5 * (P0 + P1))));
        const Vec3 next = state.orientation.conjugate() * L;
        const double change = (next - P1).cwiseAbs().maxCoeff();
        P1 = next;
        if (change <= 1e-15 * L.norm()) break;
    }
}

double kinetic_energy(const RigidBody& body, const BodyState& state) {
    return 0.5 * body.mass * state.velocity.squaredNorm() +
           0.5 * angular_velocity(body, state).dot(state.angular_momentum);
}

}  // namespace birm3d
