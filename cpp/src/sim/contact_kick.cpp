#include "birm3d/sim/contact_kick.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/closed_members.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/kernels/joints.hpp"
#include "birm3d/kernels/tires.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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

// Normal impulses of the tyres by wheel.
void tire_impulses(const Scene& scene, const std::vector<RigidContact>& contacts, std::vector<Column>& tire) {
    for (std::size_t u = 0; u < tire.size(); ++u)
        tire[u].assign(scene.vehicle->units[u].wheels.size(), 0.0);
    for (const RigidContact& contact : contacts)
        if (contact.source == ContactSource::tire) tire[contact.body][contact.index] += contact.impulse;
}

// Solves for the impulses of contacts and their friction on top of the bodies' motion, and kicks the bodies.
void kick_by_contacts(const Scene& scene, std::vector<ContactBody>& bodies, ImpulseSolver& solver,
                      ContactKick& kicked, State& state) {
    const std::size_t units = state.units.size();
    kicked.on_ground.assign(units, {});
    kicked.on_members.assign(units, {});
    const std::vector<Twist> motion = motions(scene, state);
    std::vector<Column> tire(units);
    const auto solve = [&] {
        for (std::size_t u = 0; u < units; ++u) {
            const BodyState& now = state.units[u].body;
            bodies[u].motion = {now.velocity, bodies[u].inverse_inertia * now.angular_momentum};
        }
        solver.solve(kicked.contacts, bodies);
        tire_impulses(scene, kicked.contacts, tire);
    };
    solve();
    // Friction follows from the normal impulses and tips the body, which changes them: to and fro, until they stay.
    constexpr int most_rounds = 30;
    Column last;
    for (int round = 0; round < most_rounds; ++round) {
        if (stayed(kicked.contacts, last)) break;
        for (std::size_t u = 0; u < units; ++u) {
            const Unit& unit = scene.vehicle->units[u];
            BodyState& body = state.units[u].body;
            const Wrench on_ground = tire_friction(unit, scene.settings, body, motion[u], tire[u]);
            const Wrench on_members =
                member_friction(kicked.contacts, u, unit.body,
                                tolerance::full_friction_speed * scene.reference_speed(), motion[u]);
            kick(unit.body, difference(on_ground, kicked.on_ground[u]), body);
            kick(unit.body, difference(on_members, kicked.on_members[u]), body);
            kicked.on_ground[u] = on_ground;
            kicked.on_members[u] = on_members;
        }
        if (!slides(kicked)) break;
        solve();
    }
    for (const RigidContact& contact : kicked.contacts) {
        const auto push = [&](std::size_t u, const Wrench& impulse) {
            kick(scene.vehicle->units[u].body, impulse, state.units[u].body);
        };
        push(contact.body, wrench_on_body(contact));
        if (contact.other >= 0) push(static_cast<std::size_t>(contact.other), wrench_on_other(contact));
    }
}

// `impulse` on the unit, friction included.
void add_to_obstacle(const Scene& scene, const State& state, const RigidContact& contact, const Vec3& impulse,
                     std::vector<ObstacleImpulse>& sums) {
    auto sum = std::find_if(sums.begin(), sums.end(),
                            [&](const ObstacleImpulse& known) { return known.obstacle == contact.obstacle; });
    if (sum == sums.end()) sum = sums.insert(sums.end(), {contact.obstacle, Vec3::Zero(), Vec3::Zero()});
    const Vec3 place = state.units[contact.body].body.position + contact.arm;
    sum->impulse += impulse;
    sum->torque -= (place - scene.obstacles[contact.obstacle].position).cross(impulse);
}

// Takes what would be left of the joints' gaps at the end of the drift from their targets; returns the greatest.
double correct_targets(const Scene& scene, const State& kicked, double dt,
                       std::vector<RigidContact>& contacts) {
    std::vector<BodyState> bodies;
    for (std::size_t u = 0; u < kicked.units.size(); ++u) {
        bodies.push_back(kicked.units[u].body);
        drift(scene.vehicle->units[u].body, dt, bodies.back());
    }
    double widest = 0.0;
    for (RigidContact& contact : contacts) {
        if (!contact.held) continue;
        const Joint& joint = scene.vehicle->joints[contact.index];
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

std::vector<Twist> motions(const Scene& scene, const State& state) {
    std::vector<Twist> result;
    for (std::size_t u = 0; u < state.units.size(); ++u)
        result.push_back(twist(scene.vehicle->units[u].body, state.units[u].body));
    return result;
}

std::vector<ContactBody> contact_bodies(const Scene& scene, const State& state) {
    std::vector<ContactBody> bodies;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const RigidBody& body = scene.vehicle->units[u].body;
        const BodyState& now = state.units[u].body;
        bodies.push_back({body.inverse_mass, inverse_inertia_in_world(body, now), twist(body, now)});
    }
    return bodies;
}

ContactKick kick_by_contacts(const Scene& scene, std::vector<RigidContact> contacts, State& state) {
    if (contacts.empty()) return {};
    ContactKick kicked{std::move(contacts), {}, {}};
    std::vector<ContactBody> bodies = contact_bodies(scene, state);
    ImpulseSolver solver(kicked.contacts, bodies, scene.reference_speed());
    kick_by_contacts(scene, bodies, solver, kicked, state);
    return kicked;
}

ContactKick kick_towards_closed_joints(const Scene& scene, double dt, std::vector<RigidContact> contacts,
                                       State& state) {
    if (scene.vehicle->joints.empty()) return kick_by_contacts(scene, std::move(contacts), state);
    std::vector<BodyState> start;
    for (const UnitState& unit : state.units)
        start.push_back(unit.body);
    ContactKick kicked{std::move(contacts), {}, {}};
    std::vector<ContactBody> bodies = contact_bodies(scene, state);
    ImpulseSolver solver(kicked.contacts, bodies, scene.reference_speed());
    // Each round leaves about omega dt of the gap.
    constexpr int most_rounds = 20;
    double last = infinity;
    for (int round = 0; round < most_rounds; ++round) {
        for (std::size_t u = 0; u < start.size(); ++u)
            state.units[u].body = start[u];
        kick_by_contacts(scene, bodies, solver, kicked, state);
        const double gap = correct_targets(scene, state, dt, kicked.contacts);
        if (gap <= tolerance::joint_gap || gap >= last) break;
        last = gap;
    }
    return kicked;
}

void add_impulses(const Scene& scene, const State& state, const ContactKick& kicked,
                  std::vector<ContactImpulses>& sums, std::vector<Wrench>& joints) {
    if (kicked.contacts.empty()) return;
    for (std::size_t u = 0; u < sums.size(); ++u)
        sums[u].tire_friction += kicked.on_ground[u].force;
    for (const RigidContact& contact : kicked.contacts) {
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
    if (kicked.contacts.empty()) return;
    const auto motion = [&](std::size_t u) { return mean(before[u], after[u]); };
    for (std::size_t u = 0; u < state.units.size(); ++u)
        state.energies.tire_friction -= power(kicked.on_ground[u], motion(u));
    for (const RigidContact& contact : kicked.contacts) {
        double work = power(wrench_on_body(contact), motion(contact.body));
        if (contact.other >= 0)
            work += power(wrench_on_other(contact), motion(static_cast<std::size_t>(contact.other)));
        (contact.held ? state.energies.joints : state.energies.impacts) -= work;
        if (contact.source == ContactSource::member)
            friction_of(scene, contact.obstacle, state.energies) -=
                power({contact.rubbing, contact.arm.cross(contact.rubbing)}, motion(contact.body));
    }
}

}  // namespace birm3d
