#include "birm3d/kernels/closed_members.hpp"

#include <algorithm>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// What a turn within the step adds to a point's straight way: its centripetal part.
double bend(const TrussMesh& mesh, const Twist& motion, double dt) {
    return tolerance::touching_gap + 0.5 * motion.angular_velocity.squaredNorm() * mesh.reach * dt * dt;
}

// Can any point of the box be nearer to the surface than `margin`? A gap changes by no more than the way.
bool within_reach(const PlacedShape& shape, const Box& box, double margin) {
    return nearest(*shape.shape, shape.placement.to_own(box.center)).gap - box.half.norm() < margin;
}

}  // namespace

double member_margin(const TrussMesh& mesh, const Twist& motion, double dt) {
    return bend(mesh, motion, dt) +
           dt * (motion.velocity.norm() + motion.angular_velocity.norm() * mesh.reach);
}

void find_closed_members(const TrussMesh& mesh, std::size_t body, const BodyState& state,
                         std::span<const PlacedShape> shapes, const Twist& motion, double dt,
                         std::vector<RigidContact>& contacts) {
    const auto relative = [&motion](const PlacedShape& shape) {
        return Twist{motion.velocity - shape.motion.velocity,
                     motion.angular_velocity - shape.motion.angular_velocity};
    };
    double margin = 0.0;
    for (const PlacedShape& shape : shapes)
        margin = std::max(margin, member_margin(mesh, relative(shape), dt));
    std::vector<const PlacedShape*> near;
    for (std::size_t b = 0; b < mesh.skin_blocks; ++b) {
        near.clear();
        for (const PlacedShape& shape : shapes)
            if (within_reach(shape, mesh.anchor_box[b], margin)) near.push_back(&shape);
        if (near.empty()) continue;
        for (std::size_t i = b * lanes; i < (b + 1) * lanes && i < mesh.skin; ++i) {
            const Vec3 anchor = mesh.anchor(i);
            // Of the nearest surface only: behind a neighbour's face its edges are no obstacle.
            const PlacedShape* at = nullptr;
            Nearest found{margin, Vec3::Zero()};
            for (const PlacedShape* shape : near) {
                const Nearest there = nearest(*shape->shape, shape->placement.to_own(anchor));
                if (there.gap < found.gap) found = there, at = shape;
            }
            if (at == nullptr) continue;
            const Vec3 normal = at->placement.rotation.transpose() * found.normal;
            const Twist there = relative(*at);
            const double approach = -normal.dot(there.velocity + there.angular_velocity.cross(anchor));
            if (found.gap >= bend(mesh, there, dt) + dt * std::max(0.0, approach)) continue;
            RigidContact contact;
            contact.source = ContactSource::member;
            contact.index = i;
            contact.obstacle = at->obstacle;
            contact.body = body;
            contact.arm = state.orientation * anchor;
            contact.normal = state.orientation * normal;
            contact.gap = found.gap;
            contact.compliance = tolerance::body_compliance;
            contact.friction = at->friction;
            contacts.push_back(contact);
        }
    }
}

Wrench member_friction(std::span<RigidContact> contacts, std::size_t body, const RigidBody& model,
                       double full_speed, const Twist& motion) {
    const auto slides = [body](const RigidContact& contact) {
        return contact.source == ContactSource::member && contact.body == body && contact.impulse > 0.0;
    };
    double total = 0.0;
    for (const RigidContact& contact : contacts)
        if (slides(contact)) total += contact.friction * contact.impulse;
    // Twice the speed that full friction would take from the mass centre, as the body also turns.
    const double slowest = std::max(full_speed, 2.0 * total * model.inverse_mass);
    Wrench sum;
    for (RigidContact& contact : contacts) {
        if (contact.body != body || contact.source != ContactSource::member) continue;
        contact.rubbing = Vec3::Zero();
        if (!slides(contact)) continue;
        const Vec3 velocity =
            motion.velocity + motion.angular_velocity.cross(contact.arm) - contact.sliding_surface;
        const Vec3 sliding = velocity - velocity.dot(contact.normal) * contact.normal;
        contact.rubbing = -contact.friction * contact.impulse / std::max(sliding.norm(), slowest) * sliding;
        sum += {contact.rubbing, contact.arm.cross(contact.rubbing)};
    }
    return sum;
}

}  // namespace birm3d
