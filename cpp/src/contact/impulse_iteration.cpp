// Normal impulses and friction depend on each other. They are computed alternately until they converge.
#include "contact/impulse_iteration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "birm3d/base/tolerances.hpp"
#include "contact/segment_sliding.hpp"
#include "kernels/core_friction.hpp"
#include "kernels/integrate.hpp"
#include "kernels/joints.hpp"
#include "kernels/tires.hpp"
#include "scene/bodies.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool slides(const ContactKick& kicked) {
    const auto is_there = [](const Wrench& friction) { return !friction.force.isZero(0.0); };
    return std::any_of(kicked.on_ground.begin(), kicked.on_ground.end(), is_there) ||
           std::any_of(kicked.on_cores.begin(), kicked.on_cores.end(), is_there);
}

// Have the normal impulses converged since the last round? Stores them for the next one.
bool stayed(const std::vector<RigidContact>& contacts, Column& last) {
    last.resize(contacts.size(), -1.0);
    double sum = 0.0, change = 0.0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        if (contacts[i].bilateral) continue;
        sum += contacts[i].impulse;
        change = std::max(change, std::abs(contacts[i].impulse - last[i]));
        last[i] = contacts[i].impulse;
    }
    return change <= tolerance::friction_settled * sum;
}

// The same for the friction of segments on the ground.
bool stayed(const std::vector<Wrench>& on_base, std::vector<Wrench>& last) {
    last.resize(on_base.size());
    double sum = 0.0, change = 0.0;
    for (std::size_t i = 0; i < on_base.size(); ++i) {
        sum += on_base[i].force.norm();
        change = std::max(change, (on_base[i].force - last[i].force).norm());
        last[i] = on_base[i];
    }
    // Relative change below which friction counts as converged. At a base corner nearly at rest, rounding decides its
    // direction.
    constexpr double settled = 1e-6;
    return change <= settled * sum;
}

// Normal impulses of the tyres by wheel. Springs and dampers take no part in an impact.
void tire_impulses(const Scene& scene, const KickedBy& by, KickMemory& memory) {
    for (std::size_t u = 0; u < memory.tire.size(); ++u) {
        memory.tire[u].assign(scene.vehicle->units[u].wheels.size(), 0.0);
        if (by.is_impact) continue;
        for (const SuspensionLoad& load : memory.sprung[u])
            memory.tire[u][load.wheel] += by.time * (load.spring + load.damper);
    }
    for (const RigidContact& contact : memory.kick.contacts)
        if (contact.source == ContactSource::tire)
            memory.tire[contact.body][contact.index] += contact.impulse;
}

bool any_sprung(const KickMemory& memory) {
    return std::any_of(memory.sprung.begin(), memory.sprung.end(),
                       [](const std::vector<SuspensionLoad>& loads) { return !loads.empty(); });
}

// Motions of the bodies at which contacts slide.
const std::vector<Twist>& sliding_motions(const KickMemory& memory) {
    return memory.sliding.empty() ? memory.pushed : memory.sliding;
}

// Motions of the bodies with the normal impulses and those of joints, without friction. Springs push joined units
// apart, and the joint resists. Without its impulse, tyres would seem to slide.
void find_held_motions(const Scene& scene, const KickedBy& by, KickMemory& memory) {
    memory.held.clear();
    if (scene.vehicle->joints.empty() || by.is_impact) return;
    memory.held = memory.pushed;
    const auto add = [&](std::size_t b, const Wrench& push) {
        memory.held[b].velocity += memory.bodies[b].inverse_mass * push.force;
        memory.held[b].angular_velocity += memory.bodies[b].inverse_inertia * push.torque;
    };
    for (const RigidContact& contact : memory.kick.contacts) {
        add(contact.body, wrench_on_body(contact));
        if (contact.other >= 0) add(static_cast<std::size_t>(contact.other), wrench_on_other(contact));
    }
}

// Reduces a friction impulse so that it does not reverse the sliding of the body. `motion`: of the body without it.
Wrench without_reversal(const Wrench& friction, const ContactBody& body, const Twist& motion) {
    const double slides = -power(friction, motion);
    const double change =
        power(friction, {body.inverse_mass * friction.force, body.inverse_inertia * friction.torque});
    return change > slides ? scaled(friction, std::max(0.0, slides / change)) : friction;
}

// The motion of a unit before the friction impulse.
Twist motion_without(const Wrench& friction, const ContactBody& body) {
    return {body.motion.velocity - body.inverse_mass * friction.force,
            body.motion.angular_velocity - body.inverse_inertia * friction.torque};
}

// Greatest speed along the ground that a unit impulse gives any segment that a unit pushes (1/kg).
double greatest_other_inverse_mass(const std::vector<RigidContact>& contacts, std::size_t unit,
                                   const std::vector<ContactBody>& bodies) {
    double greatest = 0.0;
    for (const RigidContact& contact : contacts) {
        if (contact.source != ContactSource::core || contact.body != unit || contact.other < 0) continue;
        if (!(contact.impulse > 0.0)) continue;
        const ContactBody& other = bodies[static_cast<std::size_t>(contact.other)];
        greatest = std::max(greatest, other.inverse_mass + other.inverse_inertia(2, 2) *
                                                               contact.other_arm.head<2>().squaredNorm());
    }
    return greatest;
}

// Friction of both sides of bottomed-out trusses and of tyres, by the present impulses; kicks the units by what has changed.
void kick_by_friction(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    ContactKick& kicked = memory.kick;
    const std::size_t units = state.units.size();
    const std::vector<Twist>& motion = sliding_motions(memory);
    std::vector<Wrench>& on_cores = memory.on_cores;
    on_cores.assign(memory.bodies.size(), {});
    for (std::size_t u = 0; u < units; ++u) {
        const Unit& unit = scene.vehicle->units[u];
        BodyState& body = state.units[u].body;
        const bool rolls_freely = !kicked.rolls_freely.empty() && kicked.rolls_freely[u] != 0;
        Wrench on_ground;
        if (!rolls_freely) {
            Wrench all = kicked.on_ground[u];
            all += kicked.on_cores[u];
            const bool is_held = !memory.held.empty();
            const Twist& now = is_held ? memory.held[u] : motion[u];
            on_ground =
                without_reversal(tire_friction(unit, scene.settings, body, state.units[u].steering_angle,
                                               {now, by.at_end[u]}, memory.tire[u]),
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

// Motions of the bodies without normal impulses and pins, at which friction is evaluated.
void set_friction_motions(const State& state, const ContactKick& kicked, std::vector<ContactBody>& bodies) {
    set_motions(state, bodies);
    const std::size_t units = state.units.size();
    for (std::size_t i = 0; i < kicked.on_base.size(); ++i) {
        ContactBody& body = bodies[units + i];
        Wrench push = kicked.on_base[i];
        push += kicked.on_cores[units + i];
        body.motion.velocity += body.inverse_mass * Vec3(push.force.x(), push.force.y(), 0.0);
        body.motion.angular_velocity.z() += body.inverse_inertia(2, 2) * push.torque.z();
    }
}

// If the rigid body meets free-standing segments, the pins between them are rows of the solver, too.
void prepare_solver(const Scene& scene, const State& state, KickMemory& memory) {
    std::erase_if(memory.kick.contacts,
                  [&](const RigidContact& row) { return row.body >= state.units.size(); });
    add_pin_rows(scene, state, memory, memory.kick.contacts);
    memory.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
}

// Iterates normal impulses and friction from the present motions. `memory.solver` is prepared.
void settle_impulses(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    ContactKick& kicked = memory.kick;
    std::vector<ContactBody>& bodies = memory.bodies;
    const std::size_t units = state.units.size();
    kicked.on_ground.assign(units, {});
    kicked.on_cores.assign(bodies.size(), {});
    list_motions(state, bodies, memory.pushed);
    for (RigidContact& contact : kicked.contacts) {
        if (contact.source != ContactSource::core || contact.other < 0) continue;
        const Twist& other = sliding_motions(memory)[static_cast<std::size_t>(contact.other)];
        contact.sliding_surface = other.velocity + other.angular_velocity.cross(contact.other_arm);
    }
    memory.tire.resize(units);
    const bool meets = meets_segments(kicked.contacts);
    if (meets) find_segment_friction(scene, by, state, memory);
    const auto solve = [&] {
        if (meets) prepare_solver(scene, state, memory);
        set_friction_motions(state, kicked, bodies);
        memory.solver.solve(kicked.contacts, bodies);
        tire_impulses(scene, by, memory);
    };
    solve();
    find_held_motions(scene, by, memory);
    // Friction depends on the normal impulses. It also tips the body, which changes these impulses: iterate.
    constexpr int most_rounds = 30;
    memory.last.clear();
    memory.on_base.clear();
    for (int round = 0; round < most_rounds; ++round) {
        const bool pushes_stay = stayed(kicked.contacts, memory.last);
        const bool frictions_stay = !meets || (round > 0 && stayed(kicked.on_base, memory.on_base));
        if (round > 0 && pushes_stay && frictions_stay) break;
        kick_by_friction(scene, by, memory, state);
        if (meets) find_segment_friction(scene, by, state, memory);
        if (!meets && !slides(kicked)) break;
        solve();
    }
    std::erase_if(kicked.contacts, [&](const RigidContact& row) { return row.body >= units; });
    for (const RigidContact& contact : kicked.contacts) {
        kick_body(scene, contact.body, wrench_on_body(contact), state);
        const bool on_unit = contact.other >= 0 && contact.other < static_cast<int>(units);
        if (on_unit)
            kick_body(scene, static_cast<std::size_t>(contact.other), wrench_on_other(contact), state);
    }
    // An impact that meets no segment does not change the segments.
    if (state.segments.empty() || (by.is_impact && !meets)) return;
    find_segment_friction(scene, by, state, memory);
    move_segments(scene, memory, state);
}

// Subtracts the joint gaps that would remain after the drift from the targets. Returns the greatest gap.
double correct_targets(const Scene& scene, const State& kicked, double dt,
                       std::vector<RigidContact>& contacts) {
    std::vector<BodyState> bodies;
    list_body_states(kicked, bodies);
    for (std::size_t b = 0; b < bodies.size(); ++b)
        drift(rigid_body(scene, b), dt, bodies[b]);
    double widest = 0.0;
    for (RigidContact& contact : contacts) {
        if (!contact.bilateral) continue;
        const Joint& joint = scene.joints[contact.index];
        const double gap = bilateral_gap(joint, contact, bodies[joint.leading], bodies[joint.trailing]);
        contact.target -= gap / dt;
        widest = std::max(widest, std::abs(gap));
    }
    return widest;
}

}  // namespace

void kick_by_contacts(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    memory.kick.on_base.clear();
    memory.kick.on_pins.clear();
    if (memory.kick.contacts.empty() && by.pressed.empty() && !any_sprung(memory)) {
        memory.kick.on_ground.clear();
        memory.kick.on_cores.clear();
        return;
    }
    memory.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
    settle_impulses(scene, by, memory, state);
}

void kick_towards_closed_joints(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    if (scene.vehicle->joints.empty()) return kick_by_contacts(scene, by, memory, state);
    memory.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
    memory.kick.on_base.clear();
    memory.kick.on_pins.clear();
    std::vector<BodyState> start;
    list_body_states(state, start);
    // Each round multiplies the gap by about omega dt, with the angular velocity omega.
    constexpr int most_rounds = 20;
    double last = infinity;
    for (int round = 0; round < most_rounds; ++round) {
        for (std::size_t b = 0; b < start.size(); ++b)
            body_state(state, b) = start[b];
        settle_impulses(scene, by, memory, state);
        const double gap = correct_targets(scene, state, by.drift, memory.kick.contacts);
        if (gap <= tolerance::joint_gap || gap >= last) break;
        last = gap;
    }
}

}  // namespace birm3d
