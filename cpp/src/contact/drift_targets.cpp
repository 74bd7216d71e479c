#include "contact/drift_targets.hpp"

#include <algorithm>

#include "scene/bodies.hpp"

namespace birm3d {

namespace {

// Acceleration of the gap of a point of a body, while its bodies turn freely (m/s^2).
double gap_acceleration(const RigidContact& contact, std::span<const ContactBody> bodies,
                        const State& state) {
    const auto of_point = [&](std::size_t b, const Vec3& arm) -> Vec3 {
        const Vec3& spin = bodies[b].motion.angular_velocity;
        const Vec3 change = bodies[b].inverse_inertia * body_state(state, b).angular_momentum.cross(spin);
        return spin.cross(spin.cross(arm)) + change.cross(arm);
    };
    Vec3 relative = of_point(contact.body, contact.arm);
    if (contact.other >= 0) relative -= of_point(static_cast<std::size_t>(contact.other), contact.other_arm);
    return contact.normal.dot(relative);
}

}  // namespace

void set_drift_targets(double dt, std::span<const ContactBody> bodies, const State& state,
                       std::vector<RigidContact>& contacts) {
    for (RigidContact& contact : contacts) {
        contact.target = -(contact.bilateral ? contact.gap : std::max(contact.gap, 0.0)) / dt;
        // The lowest point of a tyre is no point of its body: it moves along the tread.
        if (contact.source == ContactSource::core)
            contact.target -= 0.5 * dt * gap_acceleration(contact, bodies, state);
    }
}

}  // namespace birm3d
