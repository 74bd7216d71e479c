#include "contact/rigid_friction.hpp"

#include <algorithm>

#include "kernels/core_friction.hpp"
#include "kernels/integrate.hpp"
#include "kernels/tires.hpp"

namespace birm3d {

namespace {

// Reduces a friction impulse so that it does not reverse the sliding of the body. `motion`: of the body without it.
Wrench without_reversal(const Wrench& friction, const ContactBody& body, const Twist& motion) {
    const double slides = -power(friction, motion);
    const double change =
        power(friction, {body.inverse_mass * friction.force, body.inverse_inertia * friction.torque});
    return change > slides ? scaled(friction, std::max(0.0, slides / change)) : friction;
}

// The motion that a body would have without its friction impulse.
Twist motion_without(const Wrench& friction, const ContactBody& body) {
    return {body.motion.velocity - body.inverse_mass * friction.force,
            body.motion.angular_velocity - body.inverse_inertia * friction.torque};
}

// Greatest inverse mass of the moving elements that a unit of the vehicle pushes, at the point of contact (1/kg).
double greatest_other_inverse_mass(const std::vector<RigidContact>& contacts, std::size_t unit,
                                   const std::vector<ContactBody>& bodies) {
    double greatest = 0.0;
    for (const RigidContact& contact : contacts) {
        if (contact.source != ContactSource::core || contact.body != unit || contact.other < 0) continue;
        if (!(contact.impulse > 0.0)) continue;
        const ContactBody& other = bodies[static_cast<std::size_t>(contact.other)];
        const double turning = other.freedom == Freedom::tilt
                                   ? 0.5 * other.inverse_inertia.trace() * contact.other_arm.squaredNorm()
                                   : other.inverse_inertia(2, 2) * contact.other_arm.head<2>().squaredNorm();
        greatest = std::max(greatest, other.inverse_mass + turning);
    }
    return greatest;
}

}  // namespace

bool any_friction(const ContactKick& kicked) {
    const auto is_there = [](const Wrench& friction) { return !friction.force.isZero(0.0); };
    return std::any_of(kicked.on_ground.begin(), kicked.on_ground.end(), is_there) ||
           std::any_of(kicked.on_cores.begin(), kicked.on_cores.end(), is_there);
}

void sum_tire_impulses(const Scene& scene, const KickedBy& by, KickMemory& memory) {
    for (std::size_t u = 0; u < memory.iteration.tire.size(); ++u) {
        memory.iteration.tire[u].assign(scene.vehicle->units[u].wheels.size(), 0.0);
        if (by.is_impact) continue;
        for (const SuspensionLoad& load : memory.sprung[u])
            memory.iteration.tire[u][load.wheel] += by.time * (load.spring + load.damper);
    }
    for (const RigidContact& contact : memory.kick.contacts)
        if (contact.source == ContactSource::tire)
            memory.iteration.tire[contact.body][contact.index] += contact.impulse;
}

const std::vector<Twist>& sliding_motions(const KickMemory& memory) {
    return memory.motions.sliding.empty() ? memory.motions.pushed : memory.motions.sliding;
}

void find_held_motions(const Scene& scene, const KickedBy& by, KickMemory& memory) {
    memory.iteration.held.clear();
    if (scene.vehicle->joints.empty() || by.is_impact) return;
    memory.iteration.held = memory.motions.pushed;
    const auto add = [&](std::size_t b, const Wrench& push) {
        add_impulse(memory.bodies[b], push, memory.iteration.held[b]);
    };
    for (const RigidContact& contact : memory.kick.contacts) {
        add(contact.body, wrench_on_body(contact));
        if (contact.other >= 0) add(static_cast<std::size_t>(contact.other), wrench_on_other(contact));
    }
}

void kick_by_friction(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    ContactKick& kicked = memory.kick;
    const std::size_t units = state.units.size();
    const std::vector<Twist>& motion = sliding_motions(memory);
    std::vector<Wrench>& on_cores = memory.iteration.on_cores;
    on_cores.assign(memory.bodies.size(), {});
    for (std::size_t u = 0; u < units; ++u) {
        const Unit& unit = scene.vehicle->units[u];
        BodyState& body = state.units[u].body;
        const bool rolls_freely = !kicked.rolls_freely.empty() && kicked.rolls_freely[u] != 0;
        Wrench on_ground;
        if (!rolls_freely) {
            Wrench all = kicked.on_ground[u];
            all += kicked.on_cores[u];
            const bool is_held = !memory.iteration.held.empty();
            const Twist& now = is_held ? memory.iteration.held[u] : motion[u];
            on_ground =
                without_reversal(tire_friction(unit, scene.settings, body, state.units[u].steering_angle,
                                               {now, by.at_end[u]}, memory.iteration.tire[u]),
                                 memory.bodies[u], is_held ? now : motion_without(all, memory.bodies[u]));
        }
        on_cores[u] = core_friction(kicked.contacts, u, unit.body, scene.full_friction_speed(), motion[u],
                                    greatest_other_inverse_mass(kicked.contacts, u, memory.bodies));
        kick(unit.body, difference(on_ground, kicked.on_ground[u]), body);
        kick(unit.body, difference(on_cores[u], kicked.on_cores[u]), body);
        kicked.on_ground[u] = on_ground;
    }
    for (const RigidContact& contact : kicked.contacts)
        if (contact.source == ContactSource::core && contact.other >= 0)
            on_cores[static_cast<std::size_t>(contact.other)] +=
                {-contact.friction_impulse, -contact.other_arm.cross(contact.friction_impulse)};
    kicked.on_cores = on_cores;
}

}  // namespace birm3d
