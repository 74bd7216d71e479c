#include "birm3d/sim/half_kick.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/closed_members.hpp"
#include "birm3d/kernels/impulse.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/kernels/joints.hpp"
#include "birm3d/kernels/tires.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double power(const Wrench& w, const Twist& motion) {
    return w.force.dot(motion.velocity) + w.torque.dot(motion.angular_velocity);
}

Twist mean(const Twist& a, const Twist& b) {
    return {0.5 * (a.velocity + b.velocity), 0.5 * (a.angular_velocity + b.angular_velocity)};
}

std::vector<RigidContact> find_rigid_contacts(const Scene& scene, const State& state, double dt,
                                              const StepOptions& options) {
    std::vector<RigidContact> contacts;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const Unit& unit = scene.vehicle->units[u];
        const BodyState& body = state.units[u].body;
        if (scene.settings.ground) find_tire_contacts(unit, u, body, contacts);
        if (!scene.barrier || !options.hold_members) continue;
        const Mat3 R = body.orientation.toRotationMatrix();
        const Surface face = seen_from(scene.barrier->face, body.position, R);
        const Twist motion{R.transpose() * body.velocity, R.transpose() * angular_velocity(unit.body, body)};
        find_closed_members(unit.trusses, u, body, face, motion, dt, contacts);
    }
    const std::vector<Joint>& joints = scene.vehicle->joints;
    for (std::size_t j = 0; j < joints.size(); ++j)
        find_joint_rows(joints[j], j, state.units[joints[j].leading].body,
                        state.units[joints[j].trailing].body, contacts);
    return contacts;
}

bool approaches_hard(const RigidContact& contact, std::span<const ContactBody> bodies) {
    return !contact.held && separation_velocity(contact, bodies) < -tolerance::restitution_speed;
}

// Contacts that last: before the drift they let the body come to its surface and no further, after it they
// end its approach. What joints hold comes together in the drift, and after it moves together.
void set_lasting_targets(Stage stage, double dt, const std::vector<ContactImpulses>& before_drift,
                         std::span<const ContactBody> bodies, std::vector<RigidContact>& contacts) {
    if (stage == Stage::before_drift) {
        for (RigidContact& contact : contacts)
            contact.target =
                contact.held ? -contact.gap / dt : std::min(-contact.gap / dt, tolerance::recovery_speed);
        return;
    }
    std::erase_if(contacts, [&](const RigidContact& contact) {
        if (contact.held) return false;
        // A tyre that carried load before the drift still touches after it, whatever the turn did to its gap.
        const bool loaded =
            contact.source == ContactSource::tire && before_drift[contact.body].tire[contact.index] > 0.0;
        const bool touching = contact.gap <= tolerance::touching_gap || loaded;
        return !touching || approaches_hard(contact, bodies);
    });
}

// Impacts, Eq. 1: leaves the contacts that take part, none where nothing approaches hard. Points that arrive
// together by all but a hair share one impact: their order would be chance.
void set_impact_targets(double restitution, double reach, std::span<const ContactBody> bodies,
                        std::vector<RigidContact>& contacts) {
    const bool impact = std::any_of(contacts.begin(), contacts.end(), [&](const RigidContact& contact) {
        const double way = std::max(tolerance::touching_gap, -reach * separation_velocity(contact, bodies));
        return !contact.held && contact.gap <= way && approaches_hard(contact, bodies);
    });
    std::erase_if(contacts, [&](const RigidContact& contact) {
        const double way =
            std::max(tolerance::joint_impact_gap, -reach * separation_velocity(contact, bodies));
        return !impact || (!contact.held && contact.gap > way);
    });
    for (RigidContact& contact : contacts) {
        const double v = separation_velocity(contact, bodies);
        contact.target = approaches_hard(contact, bodies) ? -restitution * v : 0.0;
    }
}

// Time until the first contact that approaches hard reaches its surface (s).
double time_to_impact(std::span<const ContactBody> bodies, const std::vector<RigidContact>& contacts) {
    double earliest = infinity;
    for (const RigidContact& contact : contacts)
        if (contact.gap > tolerance::touching_gap && approaches_hard(contact, bodies))
            earliest = std::min(earliest, -contact.gap / separation_velocity(contact, bodies));
    return earliest;
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

std::vector<Twist> motions(const Scene& scene, const State& state) {
    std::vector<Twist> result;
    for (std::size_t u = 0; u < state.units.size(); ++u)
        result.push_back(twist(scene.vehicle->units[u].body, state.units[u].body));
    return result;
}

void kick_by_forces(const Scene& scene, Stage stage, double half, Trial& trial) {
    for (std::size_t u = 0; u < trial.state.units.size(); ++u) {
        const RigidBody& body = scene.vehicle->units[u].body;
        UnitState& unit = trial.state.units[u];
        const HigherOrder& extra = trial.higher_order[u];
        Load load = scaled(unit.course.now, half);
        load += stage == Stage::before_drift ? extra.lead : difference(extra.correction, extra.lead);
        Wrench impulse = load.wrench;
        impulse.force.z() -= half * body.mass * scene.settings.gravity;
        kick(body, impulse, unit.body);
    }
}

void book_forces(const std::vector<Twist>& before, const std::vector<Twist>& after, double half,
                 State& state) {
    for (std::size_t u = 0; u < state.units.size(); ++u)
        state.energies.barrier_friction -=
            half * power(state.units[u].skin.friction, mean(before[u], after[u]));
}

// What contacts do at one end of the drift, with their friction.
struct ContactKick {
    std::vector<RigidContact> contacts;
    std::vector<Wrench> on_ground, on_barrier;  // (units) friction impulses
};

bool slides(const ContactKick& kicked) {
    const auto is_there = [](const Wrench& friction) { return !friction.force.isZero(0.0); };
    return std::any_of(kicked.on_ground.begin(), kicked.on_ground.end(), is_there) ||
           std::any_of(kicked.on_barrier.begin(), kicked.on_barrier.end(), is_there);
}

double normal_impulse(const std::vector<RigidContact>& contacts) {
    double sum = 0.0;
    for (const RigidContact& contact : contacts)
        if (!contact.held) sum += contact.impulse;
    return sum;
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
    kicked.on_barrier.assign(units, {});
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
    // Friction follows from the normal impulses and tips the body, which changes them: to and fro, until their
    // sum stays. Where only gravity and the ground act it does at once; at impacts it takes some rounds.
    constexpr int most_rounds = 30;
    double carried = -1.0;
    for (int round = 0; round < most_rounds; ++round) {
        const double now = normal_impulse(kicked.contacts);
        if (std::abs(now - carried) <= 1e-12 * now) break;
        carried = now;
        for (std::size_t u = 0; u < units; ++u) {
            const Unit& unit = scene.vehicle->units[u];
            BodyState& body = state.units[u].body;
            const Wrench on_ground = tire_friction(unit, scene.settings, body, motion[u], tire[u]);
            Wrench on_barrier;
            if (scene.barrier && scene.barrier->friction > 0.0)
                on_barrier =
                    member_friction(kicked.contacts, u, unit.body, scene.barrier->friction,
                                    tolerance::full_friction_speed * scene.reference_speed(), motion[u]);
            kick(unit.body, difference(on_ground, kicked.on_ground[u]), body);
            kick(unit.body, difference(on_barrier, kicked.on_barrier[u]), body);
            kicked.on_ground[u] = on_ground;
            kicked.on_barrier[u] = on_barrier;
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

ContactKick kick_by_contacts(const Scene& scene, std::vector<RigidContact> contacts, State& state) {
    if (contacts.empty()) return {};
    ContactKick kicked{std::move(contacts), {}, {}};
    std::vector<ContactBody> bodies = contact_bodies(scene, state);
    ImpulseSolver solver(kicked.contacts, bodies, scene.reference_speed());
    kick_by_contacts(scene, bodies, solver, kicked, state);
    return kicked;
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

// Before the drift: with joints, so that they are closed after it (Ryckaert, Ciccotti and Berendsen, J. Comput.
// Phys. 23, 1977, p. 327; with velocities that agree after it: Andersen, J. Comput. Phys. 52, 1983, p. 24).
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

void add_impulses(const ContactKick& kicked, std::vector<ContactImpulses>& sums,
                  std::vector<Wrench>& joints) {
    if (kicked.contacts.empty()) return;
    for (std::size_t u = 0; u < sums.size(); ++u) {
        sums[u].tire_friction += kicked.on_ground[u].force;
        sums[u].barrier += kicked.on_barrier[u].force;
    }
    for (const RigidContact& contact : kicked.contacts) {
        const Vec3 impulse = contact.impulse * contact.normal;
        ContactImpulses& sum = sums[contact.body];
        switch (contact.source) {
            case ContactSource::tire:
                sum.tire[contact.index] += contact.impulse;
                break;
            case ContactSource::member:
                sum.barrier += impulse;
                sum.barrier_normal += contact.impulse;
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

void book_contacts(const ContactKick& kicked, const std::vector<Twist>& before,
                   const std::vector<Twist>& after, State& state) {
    if (kicked.contacts.empty()) return;
    const auto motion = [&](std::size_t u) { return mean(before[u], after[u]); };
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        state.energies.barrier_friction -= power(kicked.on_barrier[u], motion(u));
        state.energies.tire_friction -= power(kicked.on_ground[u], motion(u));
    }
    for (const RigidContact& contact : kicked.contacts) {
        double work = power(wrench_on_body(contact), motion(contact.body));
        if (contact.other >= 0)
            work += power(wrench_on_other(contact), motion(static_cast<std::size_t>(contact.other)));
        (contact.held ? state.energies.joints : state.energies.impacts) -= work;
    }
}

// State and energies beside an impact.
void keep(const Scene& scene, const State& state, Impact& impact) {
    impact.happened = true;
    impact.bodies.clear();
    impact.energies = state.energies;
    impact.energies.kinetic = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        impact.bodies.push_back(state.units[u].body);
        impact.energies.kinetic += kinetic_energy(scene.vehicle->units[u].body, state.units[u].body);
    }
}

// An impact takes no time: it stands apart from the forces of the step, in the ledger and in the record.
void impact_at_once(const Scene& scene, Stage stage, double reach, std::vector<RigidContact> contacts,
                    Trial& trial) {
    if (contacts.empty()) return;
    State& state = trial.state;
    set_impact_targets(scene.settings.restitution, reach, contact_bodies(scene, state), contacts);
    if (contacts.empty()) return;
    const bool start = stage == Stage::before_drift;
    Impact& impact = start ? trial.at_start : trial.at_end;
    if (!start) keep(scene, state, impact);
    const std::vector<Twist> before = motions(scene, state);
    const ContactKick kicked = kick_by_contacts(scene, std::move(contacts), state);
    add_impulses(kicked, impact.impulses, impact.joint_impulses);
    book_contacts(kicked, before, motions(scene, state), state);
    if (start) keep(scene, state, impact);
}

void note_depth(const std::vector<RigidContact>& contacts, StepStatistics& statistics) {
    for (const RigidContact& contact : contacts)
        if (contact.source == ContactSource::member)
            statistics.deepest_point = std::max(statistics.deepest_point, -contact.gap);
}

}  // namespace

void half_kick(const Scene& scene, Stage stage, const StepOptions& options, Trial& trial) {
    State& state = trial.state;
    const double half = 0.5 * trial.dt;
    const std::vector<RigidContact> contacts = find_rigid_contacts(scene, state, trial.dt, options);
    if (stage == Stage::before_drift) {
        // Where impacts are not located, those of the coming step happen now, before anything has passed.
        impact_at_once(scene, stage, options.locate_impacts ? 0.0 : trial.dt, contacts, trial);
    } else {
        note_depth(contacts, state.statistics);
    }

    const std::vector<Twist> before = motions(scene, state);
    kick_by_forces(scene, stage, half, trial);
    if (contacts.empty()) {
        book_forces(before, motions(scene, state), half, state);
        return;
    }
    std::vector<RigidContact> lasting = contacts;
    const std::vector<ContactBody> bodies = contact_bodies(scene, state);
    if (stage == Stage::before_drift && options.locate_impacts)
        trial.impact_after = time_to_impact(bodies, contacts);
    set_lasting_targets(stage, trial.dt, trial.impulses, bodies, lasting);
    const ContactKick kicked = stage == Stage::before_drift
                                   ? kick_towards_closed_joints(scene, trial.dt, std::move(lasting), state)
                                   : kick_by_contacts(scene, std::move(lasting), state);
    add_impulses(kicked, trial.impulses, trial.joint_impulses);
    const std::vector<Twist> after = motions(scene, state);
    book_forces(before, after, half, state);
    book_contacts(kicked, before, after, state);

    if (stage == Stage::after_drift) impact_at_once(scene, stage, 0.0, contacts, trial);
}

}  // namespace birm3d
