#include "contact/rigid_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "birm3d/base/tolerances.hpp"
#include "contact/base_reactions.hpp"
#include "kernels/core_friction.hpp"
#include "kernels/detect.hpp"
#include "kernels/detect_core.hpp"
#include "kernels/integrate.hpp"
#include "kernels/joints.hpp"
#include "kernels/tires.hpp"
#include "scene/bodies.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

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

// The energy term that the loss of a contact's normal impulse adds to.
double& lost_in(const RigidContact& contact, Energies& energies) {
    if (!contact.bilateral) return energies.impacts;
    return may_slide(contact) ? energies.sliding : energies.joints;
}

}  // namespace

void find_rigid_contacts(const Scene& scene, const State& state, double dt, const StepOptions& options,
                         KickMemory& memory) {
    std::vector<RigidContact>& contacts = memory.contacts;
    std::vector<PlacedShape>& placed = memory.placed;
    std::vector<std::size_t>& about = memory.about;
    contacts.clear();
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const Unit& unit = scene.vehicle->units[u];
        const BodyState& body = state.units[u].body;
        if (scene.settings.ground)
            find_tire_contacts(unit, u, body, state.units[u].given_way, WheelAt::bump_stop, contacts);
        if (scene.obstacles.empty() || !options.hold_core) continue;
        const Twist motion = twist_in_body_axes(unit.body, body);
        placed.clear();
        const Box& anchors = unit.trusses.anchors;
        scene.map.find(body.position, unit.trusses.reach + core_margin(unit.trusses, motion, dt), about);
        for (const std::size_t i : about) {
            if (i == scene.ground && !scene.skin_meets_ground[u]) continue;
            const Obstacle& obstacle = scene.obstacles[i];
            const Placement in_shape = placement(pose_of(scene, i, state), body);
            const Twist other = obstacle_motion(scene, i, state, body);
            const Twist relative{motion.velocity - other.velocity,
                                 motion.angular_velocity - other.angular_velocity};
            if (within_reach(obstacle.shape, in_shape, anchors, core_margin(unit.trusses, relative, dt)))
                placed.push_back(
                    {&obstacle.shape, in_shape, i, obstacle.friction, other, pushes_on(state.units[u], i)});
        }
        if (placed.empty()) continue;
        const std::size_t first = contacts.size();
        find_core_contacts(unit, u, state.units[u], placed, motion, dt, contacts);
        for (std::size_t i = first; i < contacts.size(); ++i) {
            RigidContact& contact = contacts[i];
            contact.other = body_of_obstacle(scene, contact.obstacle);
            if (contact.other >= 0)
                contact.other_arm = contact.arm + body.position -
                                    body_state(state, static_cast<std::size_t>(contact.other)).position;
        }
    }
    const std::vector<Joint>& joints = scene.vehicle->joints;
    for (std::size_t j = 0; j < joints.size(); ++j)
        find_joint_rows(joints[j], j, body_state(state, joints[j].leading),
                        body_state(state, joints[j].trailing), contacts);
}

void set_motions(const State& state, std::vector<ContactBody>& bodies) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const BodyState& now = body_state(state, b);
        bodies[b].motion = {now.velocity, bodies[b].inverse_inertia * now.angular_momentum};
    }
}

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
        const Freedom freedom = b < state.units.size() ? Freedom::all
                                : scene.tilts()        ? Freedom::tilt
                                                       : Freedom::planar;
        // A body that rotates about the vertical only has the same inertia at any yaw.
        Mat3 inverse_inertia = Mat3::Zero();
        if (freedom == Freedom::planar) {
            inverse_inertia(2, 2) = body.inverse_inertia(2, 2);
        } else if (freedom == Freedom::tilt) {
            inverse_inertia = inverse_inertia_of_post(body, body_state(state, b));
        } else {
            inverse_inertia = inverse_inertia_in_world(body, body_state(state, b));
        }
        bodies.push_back({body.inverse_mass, inverse_inertia, {}, freedom});
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
    const Twist other_motion = mean(before[b], after[b]);
    motion.velocity -=
        other_motion.velocity +
        other_motion.angular_velocity.cross(state.units[u].body.position - body_state(state, b).position);
    motion.angular_velocity -= other_motion.angular_velocity;
    return motion;
}

void add_impulses(const Scene& scene, const State& state, const ContactKick& kicked,
                  std::vector<ContactImpulses>& sums, std::vector<Wrench>& joints) {
    if (kicked.on_ground.empty()) return;
    for (std::size_t u = 0; u < sums.size(); ++u)
        sums[u].tire_friction += kicked.on_ground[u].force;
    for (const RigidContact& contact : kicked.contacts) {
        const Vec3 impulse = contact.impulse * contact.normal;
        ContactImpulses& sum = sums[contact.body];
        switch (contact.source) {
            case ContactSource::tire:
                sum.tire[contact.index] += contact.impulse;
                break;
            case ContactSource::core:
                add_to_obstacle(scene, state, contact, impulse + contact.friction_impulse, sum.obstacles);
                if (contact.obstacle != scene.ground) sum.barrier_normal += contact.impulse;
                if (contact.impulse > 0.0) ++sum.core_contacts;
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

double loss_of(const RigidContact& contact, std::span<const Twist> before, std::span<const Twist> after) {
    const auto motion = [&](std::size_t body) { return mean(before[body], after[body]); };
    double work = power(wrench_on_body(contact), motion(contact.body));
    if (contact.other >= 0)
        work += power(wrench_on_other(contact), motion(static_cast<std::size_t>(contact.other)));
    return -work;
}

double friction_loss(const Scene& scene, const State& state, const RigidContact& contact,
                     std::span<const Twist> before, std::span<const Twist> after) {
    return -power({contact.friction_impulse, contact.arm.cross(contact.friction_impulse)},
                  relative_motion(scene, state, contact.body, contact.obstacle, before, after));
}

void book_contacts(const Scene& scene, const ContactKick& kicked, const std::vector<Twist>& before,
                   const std::vector<Twist>& after, State& state) {
    const auto motion = [&](std::size_t u) { return mean(before[u], after[u]); };
    double& at_base = scene.tilts() ? state.energies.yielding : state.energies.barrier_ground_friction;
    for (std::size_t i = 0; i < kicked.on_base.size(); ++i)
        at_base -= power(kicked.on_base[i], motion(state.units.size() + i));
    for (std::size_t i = 0; i < kicked.on_pins.size(); ++i)
        state.energies.joints -= power(kicked.on_pins[i], motion(state.units.size() + i));
    for (std::size_t u = 0; u < kicked.on_ground.size(); ++u)
        state.energies.tire_friction -= power(kicked.on_ground[u], motion(u));
    double lost_at_posts = 0.0;
    for (const RigidContact& contact : kicked.contacts) {
        const double loss = loss_of(contact, before, after);
        const bool at_post = scene.tilts() && pushes_moving_element(contact);
        (at_post ? lost_at_posts : lost_in(contact, state.energies)) += loss;
        if (contact.source == ContactSource::core)
            friction_of(scene, contact.obstacle, state.energies) +=
                friction_loss(scene, state, contact, before, after);
    }
    // Posts that their plastic moments hold against the rigid core push the core: that is a part of the moments' work. In an
    // impact, a single contact may gain what others lose.
    (lost_at_posts < 0.0 ? at_base : state.energies.impacts) += lost_at_posts;
}

}  // namespace birm3d
