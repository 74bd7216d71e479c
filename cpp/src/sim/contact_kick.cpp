#include "birm3d/sim/contact_kick.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/ground_slide.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/kernels/joints.hpp"
#include "birm3d/kernels/member_friction.hpp"
#include "birm3d/kernels/tires.hpp"
#include "birm3d/sim/bodies.hpp"
#include "birm3d/sim/obstacles.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void set_motions(const State& state, std::vector<ContactBody>& bodies) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const BodyState& now = body_state(state, b);
        bodies[b].motion = {now.velocity, bodies[b].inverse_inertia * now.angular_momentum};
    }
}

bool slides(const ContactKick& kicked) {
    const auto is_there = [](const Wrench& friction) { return !friction.force.isZero(0.0); };
    return std::any_of(kicked.on_ground.begin(), kicked.on_ground.end(), is_there) ||
           std::any_of(kicked.on_members.begin(), kicked.on_members.end(), is_there);
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
    constexpr double settled = 1e-6;  // what holds a corner that is all but at rest hangs on rounding
    return change <= settled * sum;
}

// Greatest friction impulse of the ground on each segment (N s).
Column friction_limits(const Scene& scene, const Column& pressed, const ContactKick& kicked) {
    Column limits = pressed;
    for (const RigidContact& contact : kicked.contacts)
        if (contact.source == ContactSource::member && contact.other >= 0)
            limits[contact.obstacle] += contact.impulse * contact.normal.z() + contact.rubbing.z();
    for (double& limit : limits)
        limit = scene.barrier->free_standing->ground_friction * std::max(0.0, limit);
    return limits;
}

// What friction holds is at rest but for rounding, and for what pins and friction leave to each other; then it is at
// rest. Share of the speed that friction can take from a segment which it may have left.
void bring_to_rest(const Scene& scene, const Column& limits, State& state) {
    constexpr double left_over = 1e-4;
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const Segment& segment = scene.barrier->segments[i];
        BodyState& body = state.segments[i];
        if (fastest_point(segment, body) <= left_over * segment.body.inverse_mass * limits[i])
            body.velocity = body.angular_momentum = Vec3::Zero();
    }
}

// Friction of the ground on each segment, on top of what else moves it; pins are found with it.
void rub_on_ground(const Scene& scene, const std::vector<ContactBody>& bodies, const Column& pressed,
                   ContactKick& kicked, State& state) {
    const std::size_t units = state.units.size();
    std::vector<PinnedSlab> slabs;
    std::vector<SlabPin> pins;
    const Column limits = friction_limits(scene, pressed, kicked);
    bool any = false;  // does anything move?
    const bool guessed = std::any_of(kicked.on_base.begin(), kicked.on_base.end(),
                                     [](const Wrench& friction) { return !friction.force.isZero(0.0); });
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const Segment& segment = scene.barrier->segments[i];
        PinnedSlab slab{
            &segment.body, {}, limits[i], twist(segment.body, state.segments[i]), bodies[units + i].motion};
        slab.motion.velocity -= segment.body.inverse_mass * kicked.on_base[i].force;
        slab.motion.angular_velocity -= segment.body.inverse_inertia * kicked.on_base[i].torque;
        for (std::size_t c = 0; c < slab.arm.size(); ++c)
            slab.arm[c] = state.segments[i].orientation * segment.corner[c];
        slabs.push_back(slab);
    }
    for (const RigidContact& contact : kicked.contacts) {
        const bool is_pin = contact.body >= units;
        if (is_pin) {
            const auto on = [&](const Vec3& arm, double sign) {
                const Wrench unit = unit_wrench(contact, arm);
                return Vec3(sign * unit.force.x(), sign * unit.force.y(), sign * unit.torque.z());
            };
            pins.push_back({contact.body - units, static_cast<std::size_t>(contact.other) - units,
                            on(contact.arm, 1.0), on(contact.other_arm, -1.0), contact.target});
        } else if (contact.source == ContactSource::member && contact.other >= 0) {
            const Wrench push = wrench_on_other(contact);
            PinnedSlab& slab = slabs[contact.obstacle];
            slab.motion.velocity += slab.body->inverse_mass * Vec3(push.force.x(), push.force.y(), 0.0);
            slab.motion.angular_velocity.z() += slab.body->inverse_inertia(2, 2) * push.torque.z();
        }
    }
    for (const PinnedSlab& slab : slabs)
        any = any || !slab.motion.velocity.isZero(0.0) || !slab.motion.angular_velocity.isZero(0.0);
    std::vector<Wrench> next(slabs.size());
    if (any && !pins.empty()) next = slide_friction(slabs, pins, guessed);
    if (any && pins.empty())
        for (std::size_t i = 0; i < slabs.size(); ++i)
            next[i] = slide_friction(*slabs[i].body, slabs[i].arm, slabs[i].limit, slabs[i].motion);
    for (std::size_t i = 0; i < next.size(); ++i) {
        kick_body(scene, units + i, difference(next[i], kicked.on_base[i]), state);
        kicked.on_base[i] = next[i];
    }
}

// Normal impulses of the tyres by wheel.
void tire_impulses(const Scene& scene, const std::vector<RigidContact>& contacts, std::vector<Column>& tire) {
    for (std::size_t u = 0; u < tire.size(); ++u)
        tire[u].assign(scene.vehicle->units[u].wheels.size(), 0.0);
    for (const RigidContact& contact : contacts)
        if (contact.source == ContactSource::tire) tire[contact.body][contact.index] += contact.impulse;
}

// The motions at which they slide are those at hand; `memory.solver` is prepared.
void settle_impulses(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    ContactKick& kicked = memory.kick;
    std::vector<ContactBody>& bodies = memory.bodies;
    const std::size_t units = state.units.size();
    kicked.on_ground.assign(units, {});
    kicked.on_members.assign(bodies.size(), {});
    list_motions(state, bodies, memory.pushed);
    const std::vector<Twist>& motion = memory.pushed;
    // What a round before this one has found is where the search begins.
    kicked.on_base.resize(state.segments.size());
    for (std::size_t i = 0; i < kicked.on_base.size(); ++i)
        kick_body(scene, units + i, kicked.on_base[i], state);
    for (RigidContact& contact : kicked.contacts) {
        if (contact.source != ContactSource::member || contact.other < 0) continue;
        const Twist& other = motion[static_cast<std::size_t>(contact.other)];
        contact.sliding_surface = other.velocity + other.angular_velocity.cross(contact.other_arm);
    }
    std::vector<Column>& tire = memory.tire;
    tire.resize(units);
    const auto solve = [&] {
        set_motions(state, bodies);
        memory.solver.solve(kicked.contacts, bodies);
        tire_impulses(scene, kicked.contacts, tire);
    };
    solve();
    // Friction follows from the normal impulses and tips the body, which changes them: to and fro, until they stay.
    constexpr int most_rounds = 30;
    memory.last.clear();
    memory.on_base.clear();
    for (int round = 0; round < most_rounds; ++round) {
        const bool pushes_stay = stayed(kicked.contacts, memory.last);
        const bool frictions_stay = round > 0 && stayed(kicked.on_base, memory.on_base);
        if (pushes_stay && (frictions_stay || state.segments.empty())) break;
        // Of both sides of closed trusses.
        std::vector<Wrench>& on_members = memory.on_members;
        on_members.assign(bodies.size(), {});
        for (std::size_t u = 0; u < units; ++u) {
            const Unit& unit = scene.vehicle->units[u];
            BodyState& body = state.units[u].body;
            const Wrench on_ground =
                tire_friction(unit, scene.settings, body, {motion[u], by.at_end[u]}, tire[u]);
            on_members[u] =
                member_friction(kicked.contacts, u, unit.body, scene.full_friction_speed(), motion[u]);
            kick(unit.body, difference(on_ground, kicked.on_ground[u]), body);
            kick(unit.body, difference(on_members[u], kicked.on_members[u]), body);
            kicked.on_ground[u] = on_ground;
        }
        for (const RigidContact& contact : kicked.contacts)
            if (contact.source == ContactSource::member && contact.other >= 0)
                on_members[static_cast<std::size_t>(contact.other)] +=
                    {-contact.rubbing, -contact.other_arm.cross(contact.rubbing)};
        for (std::size_t b = units; b < bodies.size(); ++b)
            kick_body(scene, b, difference(on_members[b], kicked.on_members[b]), state);
        kicked.on_members = on_members;
        rub_on_ground(scene, bodies, by.pressed, kicked, state);
        if (state.segments.empty() && !slides(kicked)) break;
        solve();
    }
    for (const RigidContact& contact : kicked.contacts) {
        kick_body(scene, contact.body, wrench_on_body(contact), state);
        if (contact.other >= 0)
            kick_body(scene, static_cast<std::size_t>(contact.other), wrench_on_other(contact), state);
    }
    bring_to_rest(scene, friction_limits(scene, by.pressed, kicked), state);
}

// `impulse` on the unit, friction included.
void add_to_obstacle(const Scene& scene, const State& state, const RigidContact& contact, const Vec3& impulse,
                     std::vector<ObstacleImpulse>& sums) {
    auto sum = std::find_if(sums.begin(), sums.end(),
                            [&](const ObstacleImpulse& known) { return known.obstacle == contact.obstacle; });
    if (sum == sums.end()) sum = sums.insert(sums.end(), {contact.obstacle, Vec3::Zero(), Vec3::Zero()});
    const Vec3 place = state.units[contact.body].body.position + contact.arm;
    sum->impulse += impulse;
    sum->torque -= (place - pose_of(scene, contact.obstacle, state).position).cross(impulse);
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

double& friction_of(const Scene& scene, std::size_t obstacle, Energies& energies) {
    return obstacle == scene.ground ? energies.ground_friction : energies.barrier_friction;
}

double power(const Wrench& w, const Twist& motion) {
    return w.force.dot(motion.velocity) + w.torque.dot(motion.angular_velocity);
}

Twist mean(const Twist& a, const Twist& b) {
    return {0.5 * (a.velocity + b.velocity), 0.5 * (a.angular_velocity + b.angular_velocity)};
}

void list_bodies(const Scene& scene, const State& state, std::vector<ContactBody>& bodies) {
    bodies.clear();
    for (std::size_t b = 0; b < body_count(state); ++b) {
        const RigidBody& body = rigid_body(scene, b);
        bodies.push_back({body.inverse_mass,
                          inverse_inertia_in_world(body, body_state(state, b)),
                          {},
                          b >= state.units.size()});
    }
    set_motions(state, bodies);
}

void list_motions(const State& state, std::vector<ContactBody>& bodies, std::vector<Twist>& motions) {
    set_motions(state, bodies);
    motions.clear();
    for (const ContactBody& body : bodies)
        motions.push_back(body.motion);
}

Twist relative_motion(const Scene& scene, const State& state, std::size_t u, std::size_t obstacle,
                      std::span<const Twist> before, std::span<const Twist> after) {
    Twist motion = mean(before[u], after[u]);
    const int other = body_of_obstacle(scene, obstacle);
    if (other < 0) return motion;
    const auto b = static_cast<std::size_t>(other);
    const Twist of = mean(before[b], after[b]);
    motion.velocity -=
        of.velocity + of.angular_velocity.cross(state.units[u].body.position - body_state(state, b).position);
    motion.angular_velocity -= of.angular_velocity;
    return motion;
}

void kick_by_contacts(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    if (memory.kick.contacts.empty() && by.pressed.empty()) {
        memory.kick.on_ground.clear();
        memory.kick.on_members.clear();
        memory.kick.on_base.clear();
        return;
    }
    memory.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
    memory.kick.on_base.clear();
    settle_impulses(scene, by, memory, state);
}

void kick_towards_closed_joints(const Scene& scene, double dt, const KickedBy& by, KickMemory& memory,
                                State& state) {
    if (scene.joints.empty()) return kick_by_contacts(scene, by, memory, state);
    memory.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
    memory.kick.on_base.clear();
    std::vector<BodyState> start;
    list_body_states(state, start);
    // Each round leaves about omega dt of the gap.
    constexpr int most_rounds = 20;
    double last = infinity;
    for (int round = 0; round < most_rounds; ++round) {
        for (std::size_t b = 0; b < start.size(); ++b)
            body_state(state, b) = start[b];
        settle_impulses(scene, by, memory, state);
        const double gap = correct_targets(scene, state, dt, memory.kick.contacts);
        if (gap <= tolerance::joint_gap || gap >= last) break;
        last = gap;
    }
}

void add_impulses(const Scene& scene, const State& state, const ContactKick& kicked,
                  std::vector<ContactImpulses>& sums, std::vector<Wrench>& joints) {
    if (kicked.contacts.empty()) return;
    for (std::size_t u = 0; u < sums.size(); ++u)
        sums[u].tire_friction += kicked.on_ground[u].force;
    for (const RigidContact& contact : kicked.contacts) {
        if (contact.body >= sums.size()) continue;  // a pin between segments
        const Vec3 impulse = contact.impulse * contact.normal;
        ContactImpulses& sum = sums[contact.body];
        switch (contact.source) {
            case ContactSource::tire:
                sum.tire[contact.index] += contact.impulse;
                break;
            case ContactSource::member:
                add_to_obstacle(scene, state, contact, impulse + contact.rubbing, sum.obstacles);
                if (contact.obstacle != scene.ground) sum.barrier_normal += contact.impulse;
                if (contact.impulse > 0.0) ++sum.member_contacts;
                break;
            case ContactSource::joint:
                if (contact.about_axis) {
                    joints[contact.index].torque += impulse;
                } else {
                    joints[contact.index].force += impulse;
                    sum.joints += impulse;
                    sums[static_cast<std::size_t>(contact.other)].joints -= impulse;
                }
                break;
        }
    }
}

void book_contacts(const Scene& scene, const ContactKick& kicked, const std::vector<Twist>& before,
                   const std::vector<Twist>& after, State& state) {
    const auto motion = [&](std::size_t u) { return mean(before[u], after[u]); };
    for (std::size_t i = 0; i < kicked.on_base.size(); ++i)
        state.energies.segment_friction -= power(kicked.on_base[i], motion(state.units.size() + i));
    for (std::size_t u = 0; u < kicked.on_ground.size(); ++u)
        state.energies.tire_friction -= power(kicked.on_ground[u], motion(u));
    for (const RigidContact& contact : kicked.contacts) {
        double work = power(wrench_on_body(contact), motion(contact.body));
        if (contact.other >= 0)
            work += power(wrench_on_other(contact), motion(static_cast<std::size_t>(contact.other)));
        (contact.held ? state.energies.joints : state.energies.impacts) -= work;
        if (contact.source == ContactSource::member)
            friction_of(scene, contact.obstacle, state.energies) -=
                power({contact.rubbing, contact.arm.cross(contact.rubbing)},
                      relative_motion(scene, state, contact.body, contact.obstacle, before, after));
    }
}

}  // namespace birm3d
