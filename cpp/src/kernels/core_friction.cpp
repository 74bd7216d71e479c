#include "kernels/core_friction.hpp"

#include <algorithm>

namespace birm3d {

Wrench core_friction(std::span<RigidContact> contacts, std::size_t body, const RigidBody& model,
                     double full_speed, const Twist& motion, double other_inverse_mass) {
    const auto slides = [body](const RigidContact& contact) {
        return contact.source == ContactSource::core && contact.body == body && contact.impulse > 0.0;
    };
    double total = 0.0;
    for (const RigidContact& contact : contacts)
        if (slides(contact)) total += contact.friction * contact.impulse;
    // Twice the change of speed of the mass centre by full friction, as friction also rotates the body.
    const double slowest = std::max(full_speed, 2.0 * total * (model.inverse_mass + other_inverse_mass));
    Wrench sum;
    for (RigidContact& contact : contacts) {
        if (contact.body != body || contact.source != ContactSource::core) continue;
        contact.friction_impulse = Vec3::Zero();
        if (!slides(contact)) continue;
        const Vec3 velocity =
            motion.velocity + motion.angular_velocity.cross(contact.arm) - contact.sliding_surface;
        const Vec3 sliding = velocity - velocity.dot(contact.normal) * contact.normal;
        contact.friction_impulse =
            -contact.friction * contact.impulse / std::max(sliding.norm(), slowest) * sliding;
        sum += {contact.friction_impulse, contact.arm.cross(contact.friction_impulse)};
    }
    return sum;
}

}  // namespace birm3d
