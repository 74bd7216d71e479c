#include "contact/predicted_motion.hpp"

#include "birm3d/base/tolerances.hpp"
#include "contact/post_tilting.hpp"
#include "kernels/friction.hpp"
#include "kernels/integrate.hpp"
#include "kernels/tires.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

// Of a body about its mass centre, world axes.
Mat6 inertia_of(const RigidBody& body, const Mat3& R) {
    Mat6 inertia = Mat6::Zero();
    inertia.topLeftCorner<3, 3>().diagonal().array() = body.mass;
    inertia.bottomRightCorner<3, 3>() = R * body.inertia * R.transpose();
    return inertia;
}

// Inertia matrix of a large mass under each wheel that would sink into the ground in the second half of the step.
// `motion` assumes equal tyre impulses in both halves: see settled().
Mat6 ground_support(const Unit& unit, const BodyState& body, const Mat6& inertia, const Twist& motion,
                    WheelSet given_way, const ContactImpulses& impulses, std::vector<RigidContact>& memory) {
    memory.clear();
    find_tire_contacts(unit, 0, body, given_way, WheelAt::bump_stop, memory);
    const auto row_of = [](const RigidContact& contact) {
        Vec6 row;
        row << contact.normal, contact.arm.cross(contact.normal);
        return row;
    };
    const auto rigid_part = [&](const RigidContact& contact) {
        return impulses.tire[contact.index] - impulses.sprung[contact.index];
    };
    Vec6 unpushed, push = Vec6::Zero();
    unpushed << motion.velocity, motion.angular_velocity;
    for (const RigidContact& contact : memory)
        push += rigid_part(contact) * row_of(contact);
    unpushed -= inertia.ldlt().solve(push);
    Mat6 support = Mat6::Zero();
    for (const RigidContact& contact : memory) {
        const bool stands = rigid_part(contact) > 0.0 || contact.gap <= tolerance::touching_gap;
        const Vec6 row = row_of(contact);
        if (stands && row.dot(unpushed) < 0.0)
            support += tolerance::ground_mass_ratio * unit.body.mass * row * row.transpose();
    }
    return support;
}

}  // namespace

Twist predicted_motion(const Scene& scene, std::size_t u, const State& from, Trial& trial) {
    const Unit& unit = scene.vehicle->units[u];
    const BodyState& start = trial.at_start.happened ? trial.at_start.bodies[u] : from.units[u].body;
    BodyState body = trial.state.units[u].body;
    body.velocity += body.velocity - start.velocity;
    body.angular_momentum += body.angular_momentum - start.angular_momentum;
    Twist motion{body.velocity, angular_velocity(unit.body, body)};
    const Mat3 R = body.orientation.toRotationMatrix();
    const SkinForces& before = from.units[u].skin;
    if (before.resistance.trace() > 0.0) {
        const Mat6 inertia = inertia_of(unit.body, R);
        Mat6 support = Mat6::Zero();
        if (scene.settings.ground)
            support = ground_support(unit, body, inertia, motion, trial.state.units[u].given_way,
                                     trial.impulses[u], trial.memory.contacts);
        motion = settled(motion, before.friction_motion, before.resistance, trial.dt, inertia, support);
    }
    return {R.transpose() * motion.velocity, R.transpose() * motion.angular_velocity};
}

void predict_moving_elements(const Scene& scene, const State& from, double dt, State& now) {
    for (const UnitState& unit : from.units)
        for (const ContactLoad& contact : unit.contact_loads) {
            const int body = body_of_obstacle(scene, contact.obstacle);
            if (body < 0) continue;
            Load coming = scaled(contact.history.now, 0.5 * dt);
            coming += scaled(contact.history.rate, dt * dt / 3.0);
            kick_body(scene, static_cast<std::size_t>(body), reaction_of(coming), now);
        }
    if (!scene.tilts()) return;
    for (std::size_t i = 0; i < now.moving_elements.size(); ++i) {
        BodyState& post = now.moving_elements[i];
        post.angular_momentum +=
            plastic_impulse(scene.barrier->moving_elements[i], post, post.angular_momentum, 0.5 * dt);
    }
}

}  // namespace birm3d
