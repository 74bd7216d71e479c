#include "birm3d/kernels/closed_members.hpp"

#include <algorithm>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

void find_closed_members(const TrussMesh& mesh, std::size_t body, const BodyState& state, const Surface& face,
                         const Twist& motion, double dt, std::vector<RigidContact>& contacts) {
    const double spin = motion.angular_velocity.norm();
    const double fastest = motion.velocity.norm() + spin * mesh.reach;
    // What a turn within the step adds to a point's straight way: its centripetal part.
    const double bend = tolerance::touching_gap + 0.5 * spin * spin * mesh.reach * dt * dt;
    const double margin = bend + dt * fastest;
    if (!within_reach(face, mesh.anchors, margin)) return;
    for (std::size_t b = 0; b < mesh.blocks; ++b) {
        if (!within_reach(face, mesh.anchor_box[b], margin)) continue;
        for (std::size_t i = b * lanes; i < (b + 1) * lanes && i < mesh.count; ++i) {
            const Vec3 anchor = mesh.anchor(i);
            const double distance = gap(face, anchor);
            const Vec3 normal = normal_at(face, anchor);
            const double approach = -normal.dot(motion.velocity + motion.angular_velocity.cross(anchor));
            if (distance >= bend + dt * std::max(0.0, approach)) continue;
            RigidContact contact;
            contact.source = ContactSource::member;
            contact.index = i;
            contact.body = body;
            contact.arm = state.orientation * anchor;
            contact.normal = state.orientation * normal;
            contact.gap = distance;
            contact.compliance = tolerance::body_compliance;
            contacts.push_back(contact);
        }
    }
}

Wrench member_friction(std::span<const RigidContact> contacts, std::size_t body, const RigidBody& model,
                       double mu, double full_speed, const Twist& motion) {
    const auto slides = [body](const RigidContact& contact) {
        return contact.source == ContactSource::member && contact.body == body && contact.impulse > 0.0;
    };
    double total = 0.0;
    for (const RigidContact& contact : contacts)
        if (slides(contact)) total += contact.impulse;
    // Twice the speed that full friction would take from the mass centre, as the body also turns.
    const double slowest = std::max(full_speed, 2.0 * mu * total * model.inverse_mass);
    Wrench sum;
    for (const RigidContact& contact : contacts) {
        if (!slides(contact)) continue;
        const Vec3 velocity = motion.velocity + motion.angular_velocity.cross(contact.arm);
        const Vec3 sliding = velocity - velocity.dot(contact.normal) * contact.normal;
        const Vec3 impulse = -mu * contact.impulse / std::max(sliding.norm(), slowest) * sliding;
        sum += {impulse, contact.arm.cross(impulse)};
    }
    return sum;
}

}  // namespace birm3d
