#include "birm3d/sim/half_kick.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/closed_members.hpp"
#include "birm3d/kernels/detect.hpp"
#include "birm3d/kernels/impulse.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/kernels/tires.hpp"
#include "birm3d/sim/obstacles.hpp"

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
    std::vector<PlacedShape> placed;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const Unit& unit = scene.vehicle->units[u];
        const BodyState& body = state.units[u].body;
        if (scene.settings.ground) find_tire_contacts(unit, u, body, contacts);
        if (scene.obstacles.empty() || !options.hold_members) continue;
        const Mat3 R = body.orientation.toRotationMatrix();
        const Twist motion{R.transpose() * body.velocity, R.transpose() * angular_velocity(unit.body, body)};
        placed.clear();
        const Box& anchors = unit.trusses.anchors;
        for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
            if (i == scene.ground && !scene.skin_meets_ground[u]) continue;
            const Obstacle& obstacle = scene.obstacles[i];
            const Placement seen = placement(obstacle, body);
            if (within_reach(obstacle.shape, seen, anchors, member_margin(unit.trusses, motion, dt)))
                placed.push_back({&obstacle.shape, seen, i, obstacle.friction});
        }
        if (!placed.empty()) find_closed_members(unit.trusses, u, body, placed, motion, dt, contacts);
    }
    return contacts;
}

bool approaches_hard(const RigidContact& contact, std::span<const ContactBody> bodies) {
    return separation_velocity(contact, bodies) < -tolerance::restitution_speed;
}

// Contacts that last: before the drift they let the body come to its surface and no further, after it they
// end its approach.
void set_lasting_targets(Stage stage, double dt, const std::vector<ContactImpulses>& before_drift,
                         std::span<const ContactBody> bodies, std::vector<RigidContact>& contacts) {
    if (stage == Stage::before_drift) {
        for (RigidContact& contact : contacts)
            contact.target = std::min(-contact.gap / dt, tolerance::recovery_speed);
        return;
    }
    std::erase_if(contacts, [&](const RigidContact& contact) {
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
        return contact.gap <= way && approaches_hard(contact, bodies);
    });
    std::erase_if(contacts, [&](const RigidContact& contact) {
        const double way =
            std::max(tolerance::joint_impact_gap, -reach * separation_velocity(contact, bodies));
        return !impact || contact.gap > way;
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

// Solves for the contacts' normal impulses on top of the bodies' motion and adds up tyre impulses by wheel.
void solve_contacts(const Scene& scene, const State& state, std::vector<RigidContact>& contacts,
                    std::vector<Column>& tire) {
    std::vector<ContactBody> bodies = contact_bodies(scene, state);
    for (std::size_t u = 0; u < state.units.size(); ++u)
        tire[u].assign(scene.vehicle->units[u].wheels.size(), 0.0);
    solve_impulses(contacts, bodies, scene.reference_speed());
    for (const RigidContact& contact : contacts)
        if (contact.source == ContactSource::tire) tire[contact.body][contact.index] += contact.impulse;
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
        Wrench impulse;
        for (const Touch& touch : unit.touches) {
            Load load = scaled(touch.course.now, half);
            load += stage == Stage::before_drift ? touch.extra.lead
                                                 : difference(touch.extra.correction, touch.extra.lead);
            impulse += load.wrench;
        }
        impulse.force.z() -= half * body.mass * scene.settings.gravity;
        kick(body, impulse, unit.body);
    }
}

// Where what is lost to friction on an obstacle is booked.
double& friction_of(const Scene& scene, std::size_t obstacle, Energies& energies) {
    return obstacle == scene.ground ? energies.ground_friction : energies.barrier_friction;
}

void book_forces(const Scene& scene, const std::vector<Twist>& before, const std::vector<Twist>& after, double half,
                 State& state) {
    for (std::size_t u = 0; u < state.units.size(); ++u)
        for (const Touch& touch : state.units[u].touches)
            friction_of(scene, touch.obstacle, state.energies) -=
                half * power(touch.friction, mean(before[u], after[u]));
}

// What contacts do at one end of the drift, with their friction.
struct ContactKick {
    std::vector<RigidContact> contacts;
    std::vector<Wrench> on_ground, on_members;  // (units) friction impulses of tyres and of closed trusses
};

bool slides(const ContactKick& kicked) {
    const auto is_there = [](const Wrench& friction) { return !friction.force.isZero(0.0); };
    return std::any_of(kicked.on_ground.begin(), kicked.on_ground.end(), is_there) ||
           std::any_of(kicked.on_members.begin(), kicked.on_members.end(), is_there);
}

// `impulse` on the unit, friction included.
void add_to_obstacle(const Scene& scene, const State& state, const RigidContact& contact, const Vec3& impulse,
                     std::vector<ObstacleImpulse>& sums) {
    auto sum = std::find_if(sums.begin(), sums.end(), [&](const ObstacleImpulse& known) {
        return known.obstacle == contact.obstacle;
    });
    if (sum == sums.end()) sum = sums.insert(sums.end(), {contact.obstacle, Vec3::Zero(), Vec3::Zero()});
    const Vec3 place = state.units[contact.body].body.position + contact.arm;
    sum->impulse += impulse;
    sum->torque -= (place - scene.obstacles[contact.obstacle].position).cross(impulse);
}

double normal_impulse(const std::vector<RigidContact>& contacts) {
    double sum = 0.0;
    for (const RigidContact& contact : contacts)
        sum += contact.impulse;
    return sum;
}

ContactKick kick_by_contacts(const Scene& scene, std::vector<RigidContact> contacts, State& state,
                             std::vector<ContactImpulses>& sums) {
    if (contacts.empty()) return {};
    const std::size_t units = state.units.size();
    ContactKick result{std::move(contacts), std::vector<Wrench>(units), std::vector<Wrench>(units)};
    const std::vector<Twist> motion = motions(scene, state);
    std::vector<Column> tire(units);
    solve_contacts(scene, state, result.contacts, tire);
    // Friction follows from the normal impulses and tips the body, which changes them: to and fro, until their
    // sum stays. Where only gravity and the ground act it does at once; at impacts it takes some rounds.
    constexpr int most_rounds = 30;
    double carried = -1.0;
    for (int round = 0; round < most_rounds; ++round) {
        const double now = normal_impulse(result.contacts);
        if (std::abs(now - carried) <= 1e-12 * now) break;
        carried = now;
        for (std::size_t u = 0; u < units; ++u) {
            const Unit& unit = scene.vehicle->units[u];
            BodyState& body = state.units[u].body;
            const Wrench on_ground = tire_friction(unit, scene.settings, body, motion[u], tire[u]);
            const Wrench on_members =
                member_friction(result.contacts, u, unit.body,
                                tolerance::full_friction_speed * scene.reference_speed(), motion[u]);
            kick(unit.body, difference(on_ground, result.on_ground[u]), body);
            kick(unit.body, difference(on_members, result.on_members[u]), body);
            result.on_ground[u] = on_ground;
            result.on_members[u] = on_members;
        }
        if (!slides(result)) break;
        solve_contacts(scene, state, result.contacts, tire);
    }
    for (std::size_t u = 0; u < units; ++u) {
        sums[u].tire_friction += result.on_ground[u].force;
    }

    for (const RigidContact& contact : result.contacts) {
        const Vec3 impulse = contact.impulse * contact.normal;
        kick(scene.vehicle->units[contact.body].body, {impulse, contact.arm.cross(impulse)},
             state.units[contact.body].body);
        ContactImpulses& sum = sums[contact.body];
        if (contact.source == ContactSource::tire) {
            sum.tire[contact.index] += contact.impulse;
        } else {
            add_to_obstacle(scene, state, contact, impulse + contact.rubbing, sum.obstacles);
            if (contact.obstacle != scene.ground) sum.barrier_normal += contact.impulse;
            if (contact.impulse > 0.0) ++sum.member_contacts;
        }
    }
    return result;
}

void book_contacts(const Scene& scene, const ContactKick& kicked, const std::vector<Twist>& before,
                   const std::vector<Twist>& after, State& state) {
    if (kicked.contacts.empty()) return;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const Twist motion = mean(before[u], after[u]);
        state.energies.tire_friction -= power(kicked.on_ground[u], motion);
        for (const RigidContact& contact : kicked.contacts) {
            if (contact.body != u) continue;
            const Vec3 impulse = contact.impulse * contact.normal;
            state.energies.impacts -= power({impulse, contact.arm.cross(impulse)}, motion);
            if (contact.source != ContactSource::member) continue;
            friction_of(scene, contact.obstacle, state.energies) -=
                power({contact.rubbing, contact.arm.cross(contact.rubbing)}, motion);
        }
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
    const ContactKick kicked = kick_by_contacts(scene, std::move(contacts), state, impact.impulses);
    book_contacts(scene, kicked, before, motions(scene, state), state);
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
        book_forces(scene, before, motions(scene, state), half, state);
        return;
    }
    std::vector<RigidContact> lasting = contacts;
    const std::vector<ContactBody> bodies = contact_bodies(scene, state);
    if (stage == Stage::before_drift && options.locate_impacts)
        trial.impact_after = time_to_impact(bodies, contacts);
    set_lasting_targets(stage, trial.dt, trial.impulses, bodies, lasting);
    const ContactKick kicked = kick_by_contacts(scene, std::move(lasting), state, trial.impulses);
    const std::vector<Twist> after = motions(scene, state);
    book_forces(scene, before, after, half, state);
    book_contacts(scene, kicked, before, after, state);

    if (stage == Stage::after_drift) impact_at_once(scene, stage, 0.0, contacts, trial);
}

}  // namespace birm3d
