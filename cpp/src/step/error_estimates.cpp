#include "step/error_estimates.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "kernels/integrate.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

double radius_of_gyration(const RigidBody& body) {
    return std::sqrt(0.5 * body.inertia.trace() * body.inverse_mass);
}

// Fraction of a vector's length that a second-order step misses while the vector rotates by `angle`: angle^3/12.
double missed_fraction(double angle) {
    return angle * angle * angle / 12.0;
}

// Greatest ratio of the inverse effective mass of an element that moves, loaded at its end, to that of the unit.
double inverse_mass_ratio(const Scene& scene, const RigidBody& body,
                          const std::vector<ContactLoad>& contacts) {
    double most = 0.0;
    for (const ContactLoad& contact : contacts) {
        if (!(contact.obstacle < scene.moving_count()) || !(contact.normal_force > 0.0)) continue;
        const MovingElement& element = scene.barrier->moving_elements[contact.obstacle];
        if (element.tilts()) {
            most = std::max(most,
                            body.mass * element.reach * element.reach * element.body.inverse_inertia(0, 0));
            continue;
        }
        const Vec3& end = element.corner[0];
        most =
            std::max(most, body.mass * (element.body.inverse_mass + (end.x() * end.x() + end.y() * end.y()) *
                                                                        element.body.inverse_inertia(2, 2)));
    }
    return most;
}

}  // namespace

EffectiveInertia::EffectiveInertia(const RigidBody& body_, const BodyState& state)
    : body(body_),
      gyration(radius_of_gyration(body_)),
      inverse_inertia(inverse_inertia_in_world(body_, state)) {}

double velocity_error(const EffectiveInertia& inertia, const Load& departure, double dt) {
    const double force = departure.wrench.force.norm();
    const Vec3 angular_change = inertia.inverse_inertia * departure.wrench.torque;
    double change = inertia.body.inverse_mass * force + inertia.gyration * angular_change.norm();
    if (const MovingElement* segment = inertia.segment) {
        const double yaw_change =
            segment->body.inverse_inertia(2, 2) * std::abs(departure.reaction_torque.z());
        change += segment->body.inverse_mass * force + segment->half_length * yaw_change;
    }
    return dt / 8.0 * change;
}

double rotation_error(const Scene& scene, const State& state, double dt) {
    double most = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const RigidBody& body = scene.vehicle->units[u].body;
        const double omega = angular_velocity(body, state.units[u].body).norm();
        most = std::max(most, missed_fraction(omega * dt) * omega * radius_of_gyration(body));
    }
    return most;
}

double joint_error(const Scene& scene, const State& state, double dt) {
    double most = 0.0;
    for (const Joint& joint : scene.joints) {
        const auto spin = [&](std::size_t body) {
            const BodyState& state_of_body = body_state(state, body);
            return state_of_body.angular_momentum.isZero(0.0)
                       ? 0.0
                       : angular_velocity(rigid_body(scene, body), state_of_body).norm();
        };
        const double omega = std::max(spin(joint.leading), spin(joint.trailing));
        const double lever = joint.place_on_leading.norm() + joint.place_on_trailing.norm();
        most = std::max(most, missed_fraction(omega * dt) * omega * lever);
    }
    return most;
}

double weight_error(const Scene& scene, const State& from, const Trial& trial) {
    double most = 0.0;
    for (std::size_t u = 0; u < from.units.size(); ++u) {
        const Impact &first = trial.at_start, &last = trial.at_end;
        const BodyState& before = first.happened ? first.bodies[u] : from.units[u].body;
        const BodyState& after = last.happened ? last.bodies[u] : trial.state.units[u].body;
        const double mismatch = before.velocity.z() - 2.0 * trial.drift_velocity_z[u] + after.velocity.z();
        most = std::max(most, std::abs(mismatch));
    }
    return 0.5 * trial.dt * scene.settings.gravity * most / scene.reference_speed();
}

double critical_step(const Scene& scene, const RigidBody& body, const UnitState& unit) {
    const double ratio = inverse_mass_ratio(scene, body, unit.contact_loads);
    const double stiffness = unit.skin.stiffness * (1.0 + ratio);
    return stiffness > 0.0 ? tolerance::critical_phase / std::sqrt(stiffness) : infinity;
}

}  // namespace birm3d
