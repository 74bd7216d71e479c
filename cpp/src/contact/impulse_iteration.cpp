// Impulses and friction follow from each other: they are found in turns until they stay.
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

// Have the normal impulses stayed since the last round? Remembers them.
bool stayed(const std::vector<RigidContact>& contacts, Column& last) {
    last.resize(contacts.size(), -1.0);
    double sum = 0.0, change = 0.0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        if (contacts[i].held) continue;
        sum += contacts[i].impulse;
        change = std::max(change, std::abs(contacts[i].impulse - last[i]));
        last[i] = contacts[i].impulse;
    }
    return change <= tolerance::friction_settled * sum;
}

// Have the frictions of segments on the ground?
bool stayed(const std::vector<Wrench>& on_base, std::vector<Wrench>& last) {
    last.resize(on_base.size());
    double sum = 0.0, change = 0.0;
    for (std::size_t i = 0; i < on_base.size(); ++i) {
        sum += on_base[i].force.norm();
        change = std::max(change, (on_base[i].force - last[i].force).norm());
        last[i] = on_base[i];
    }
    // Friction at a base corner nearly at rest is decided by rounding: smaller changes count as converged.
    constexpr double settled = 1e-6;
    return change <= settled * sum;
}

// Normal impulses of the tyres by wheel.
void tire_impulses(const Scene& scene, const std::vector<RigidContact>& contacts, std::vector<Column>& tire) {
    for (std::size_t u = 0; u < tire.size(); ++u)
        tire[u].assign(scene.vehicle->units[u].wheels.size(), 0.0);
    for (const RigidContact& contact : contacts)
        if (contact.source == ContactSource::tire) tire[contact.body][contact.index] += contact.impulse;
}

// Motions of the bodies at which contacts slide.
const std::vector<Twist>& motions_that_rub(const KickMemory& memory) {
    return memory.sliding.empty() ? memory.pushed : memory.sliding;
}

// Friction brings sliding to rest and does not reverse it: what of its impulse on a body does no more than that.
// `motion`: of the body without it.
Wrench without_reversal(const Wrench& friction, const ContactBody& body, const Twist& motion) {
    const double slides = -power(friction, motion);
    const double gives =
        power(friction, {body.inverse_mass * friction.force, body.inverse_inertia * friction.torque});
    return gives > slides ? scaled(friction, std::max(0.0, slides / gives)) : friction;
}

// Of a unit that friction has kicked.
Twist motion_without(const Wrench& friction, const ContactBody& body) {
    return {body.motion.velocity - body.inverse_mass * friction.force,
            body.motion.angular_velocity - body.inverse_inertia * friction.torque};
}

// Greatest speed along the ground that a unit impulse gives any segment that a unit pushes (1/kg).
double greatest_give(const std::vector<RigidContact>& contacts, std::size_t unit,
                     const std::vector<ContactBody>& bodies) {
    double give = 0.0;
    for (const RigidContact& contact : contacts) {
        if (contact.source != ContactSource::core || contact.body != unit || contact.other < 0) continue;
        if (!(contact.impulse > 0.0)) continue;
        const ContactBody& other = bodies[static_cast<std::size_t>(contact.other)];
        give = std::max(give, other.inverse_mass +
                                  other.inverse_inertia(2, 2) * contact.other_arm.head<2>().squaredNorm());
    }
    return give;
}

// Friction of both sides of bottomed-out trusses and of tyres, by the present impulses; kicks the units by what has changed.
void rub_units(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    ContactKick& kicked = memory.kick;
    const std::size_t units = state.units.size();
    const std::vector<Twist>& motion = motions_that_rub(memory);
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
            on_ground = without_reversal(
                tire_friction(unit, scene.settings, body, {motion[u], by.at_end[u]}, memory.tire[u]),
                memory.bodies[u], motion_without(all, memory.bodies[u]));
        }
        on_cores[u] = core_friction(kicked.contacts, u, unit.body, scene.full_friction_speed(), motion[u],
                                    greatest_give(kicked.contacts, u, memory.bodies));
        kick(unit.body, difference(on_ground, kicked.on_ground[u]), body);
        kick(unit.body, difference(on_cores[u], kicked.on_cores[u]), body);
        kicked.on_ground[u] = on_ground;
    }
    for (const RigidContact& contact : kicked.contacts)
        if (contact.source == ContactSource::core && contact.other >= 0)
            on_cores[static_cast<std::size_t>(contact.other)] +=
                {-contact.rubbing, -contact.other_arm.cross(contact.rubbing)};
    kicked.on_cores = on_cores;
}

// Motions of the bodies without normal impulses and pins.
void set_rubbed_motions(const State& state, const ContactKick& kicked, std::vector<ContactBody>& bodies) {
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

// Where the rigid body meets segments, the pins between these are rows of the solver, too.
void prepare_solver(const Scene& scene, const State& state, KickMemory& memory) {
    std::erase_if(memory.kick.contacts,
                  [&](const RigidContact& row) { return row.body >= state.units.size(); });
    add_pin_rows(scene, state, memory, memory.kick.contacts);
    memory.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
}

// The motions at which they slide are those at hand; `memory.solver` is prepared.
void settle_impulses(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    ContactKick& kicked = memory.kick;
    std::vector<ContactBody>& bodies = memory.bodies;
    const std::size_t units = state.units.size();
    kicked.on_ground.assign(units, {});
    kicked.on_cores.assign(bodies.size(), {});
    list_motions(state, bodies, memory.pushed);
    for (RigidContact& contact : kicked.contacts) {
        if (contact.source != ContactSource::core || contact.other < 0) continue;
        const Twist& other = motions_that_rub(memory)[static_cast<std::size_t>(contact.other)];
        contact.sliding_surface = other.velocity + other.angular_velocity.cross(contact.other_arm);
    }
    memory.tire.resize(units);
    const bool meets = meets_segments(kicked.contacts);
    if (meets) rub_on_ground(scene, by, state, memory);
    const auto solve = [&] {
        if (meets) prepare_solver(scene, state, memory);
        set_rubbed_motions(state, kicked, bodies);
        memory.solver.solve(kicked.contacts, bodies);
        tire_impulses(scene, kicked.contacts, memory.tire);
    };
    solve();
    // Friction follows from the normal impulses and tips the body, which changes them: to and fro, until they stay.
    constexpr int most_rounds = 30;
    memory.last.clear();
    memory.on_base.clear();
    for (int round = 0; round < most_rounds; ++round) {
        const bool pushes_stay = stayed(kicked.contacts, memory.last);
        const bool frictions_stay = !meets || (round > 0 && stayed(kicked.on_base, memory.on_base));
        if (pushes_stay && frictions_stay) break;
        rub_units(scene, by, memory, state);
        if (meets) rub_on_ground(scene, by, state, memory);
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
    // An impact that meets no segment is none to them.
    if (state.segments.empty() || (by.is_impact && !meets)) return;
    rub_on_ground(scene, by, state, memory);
    move_segments(scene, memory, state);
}

// Takes what would be left of the joints' gaps at the end of the drift from their targets; returns the greatest.
double correct_targets(const Scene& scene, const State& kicked, double dt,
                       std::vector<RigidContact>& contacts) {
    std::vector<BodyState> bodies;
    list_body_states(kicked, bodies);
    for (std::size_t b = 0; b < bodies.size(); ++b)
        drift(rigid_body(scene, b), dt, bodies[b]);
    double widest = 0.0;
    for (RigidContact& contact : contacts) {
        if (!contact.held) continue;
        const Joint& joint = scene.joints[contact.index];
        const double gap = held_gap(joint, contact, bodies[joint.leading], bodies[joint.trailing]);
        contact.target -= gap / dt;
        widest = std::max(widest, std::abs(gap));
    }
    return widest;
}

}  // namespace

void kick_by_contacts(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    memory.kick.on_base.clear();
    memory.kick.on_pins.clear();
    if (memory.kick.contacts.empty() && by.pressed.empty()) {
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
    // Each round leaves about omega dt of the gap.
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
