#include "contact/base_reactions.hpp"

#include <algorithm>

#include "contact/post_tilting.hpp"
#include "kernels/ground_slide.hpp"
#include "kernels/joints.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

// Greatest friction impulse of the ground on each free-standing segment (N s).
void find_limits(const Scene& scene, const Column& pressed, const ContactKick& kicked, Column& limits) {
    limits = pressed;
    for (const RigidContact& contact : kicked.contacts)
        if (pushes_moving_element(contact))
            limits[contact.obstacle] += contact.impulse * contact.normal.z() + contact.friction_impulse.z();
    for (double& limit : limits)
        limit = scene.barrier->free_standing->ground_friction * std::max(0.0, limit);
}

bool is_pinned(const Scene& scene) {
    return scene.slides() && scene.barrier->free_standing->joint == SegmentJoint::pinned;
}

Vec3 planar_motion(const RigidBody& body, const Vec3& velocity, double spin_momentum) {
    return {velocity.x(), velocity.y(), body.inverse_inertia(2, 2) * spin_momentum};
}

// First two axes of a body that turns about the vertical only.
struct PlanarAxes {
    explicit PlanarAxes(const Quat& orientation)
        : x(1.0 - 2.0 * orientation.z() * orientation.z(), 2.0 * orientation.w() * orientation.z()),
          y(-x.y(), x.x()) {}
    Vec2 x, y;
};

// Lists the segments with their motions without friction and pins, and a first guess of the motions with both.
void list_slabs(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory) {
    const std::size_t units = state.units.size();
    std::vector<PinnedSlab>& slabs = memory.segments.slabs;
    slabs.resize(state.moving_elements.size());
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        const MovingElement& element = scene.barrier->moving_elements[i];
        const BodyState& body = state.moving_elements[i];
        PinnedSlab& slab = slabs[i];
        slab.mass = element.body.mass;
        slab.inertia = element.body.inertia(2, 2);
        slab.limit = memory.segments.limits[i];
        const PlanarAxes axes(body.orientation);
        for (std::size_t c = 0; c < slab.arm.size(); ++c)
            slab.arm[c] = element.corner[c].x() * axes.x + element.corner[c].y() * axes.y;
        slab.motion = planar_motion(element.body, body.velocity, body.angular_momentum.z());
        const Wrench& push = memory.kick.on_cores[units + i];
        slab.motion += element.body.inverse_mass * Vec3(push.force.x(), push.force.y(), 0.0);
        slab.motion.z() += element.body.inverse_inertia(2, 2) * push.torque.z();
        // A segment that was at rest probably stays at rest, and the solver converges fastest from there.
        const Twist& from = by.from[units + i];
        const bool rested = from.velocity.isZero(0.0) && from.angular_velocity.isZero(0.0);
        const Twist& guess = by.at_end[units + i];
        slab.guess.setZero();
        if (!rested) slab.guess = {guess.velocity.x(), guess.velocity.y(), guess.angular_velocity.z()};
    }
    for (const RigidContact& contact : memory.kick.contacts) {
        if (!pushes_moving_element(contact)) continue;
        const Wrench push = wrench_on_other(contact);
        const RigidBody& body = scene.barrier->moving_elements[contact.obstacle].body;
        Vec3& motion = slabs[contact.obstacle].motion;
        motion.head<2>() += body.inverse_mass * push.force.head<2>();
        motion.z() += body.inverse_inertia(2, 2) * push.torque.z();
    }
}

void list_pins(const Scene& scene, const State& state, std::vector<SlabPin>& pins) {
    pins.resize(state.moving_elements.size() - 1);
    for (std::size_t i = 0; i < pins.size(); ++i) {
        const BodyState &first = state.moving_elements[i], &next = state.moving_elements[i + 1];
        SlabPin& pin = pins[i];
        pin.on_first = scene.barrier->moving_elements[i].half_length * PlanarAxes(first.orientation).y;
        pin.on_next = -scene.barrier->moving_elements[i + 1].half_length * PlanarAxes(next.orientation).y;
        pin.gap = (first.position - next.position).head<2>() + pin.on_first - pin.on_next;
    }
}

Wrench wrench_along_ground(const Vec3& push) {
    return {Vec3(push.x(), push.y(), 0.0), Vec3(0.0, 0.0, push.z())};
}

void find_pinned_friction(const KickedBy& by, KickMemory& memory) {
    memory.segments.chain.solve(memory.segments.slabs, memory.segments.pins, by.drift);
    for (std::size_t i = 0; i < memory.segments.slabs.size(); ++i) {
        memory.segments.motions[i] = memory.segments.chain.motions()[i];
        memory.kick.on_base[i] = wrench_along_ground(memory.segments.chain.frictions()[i]);
        memory.kick.on_pins[i] = wrench_along_ground(memory.segments.chain.pulls()[i]);
    }
}

void find_loose_friction(const Scene& scene, KickMemory& memory) {
    for (std::size_t i = 0; i < memory.segments.slabs.size(); ++i) {
        const PinnedSlab& slab = memory.segments.slabs[i];
        Wrench& friction = memory.kick.on_base[i];
        friction = {};
        memory.segments.motions[i] = slab.motion;
        if (slab.motion.isZero(0.0)) continue;
        const RigidBody& body = scene.barrier->moving_elements[i].body;
        std::array<Vec3, 4> arm;
        for (std::size_t c = 0; c < arm.size(); ++c)
            arm[c] = {slab.arm[c].x(), slab.arm[c].y(), 0.0};
        const Vec3& v = slab.motion;
        friction = slide_friction(body, arm, slab.limit, {Vec3(v.x(), v.y(), 0.0), Vec3(0.0, 0.0, v.z())});
        memory.segments.motions[i].head<2>() += body.inverse_mass * friction.force.head<2>();
        memory.segments.motions[i].z() += body.inverse_inertia(2, 2) * friction.torque.z();
    }
}

}  // namespace

bool pushes_moving_element(const RigidContact& contact) {
    return contact.source == ContactSource::core && contact.other >= 0;
}

bool meets_moving_element(const std::vector<RigidContact>& contacts) {
    return std::any_of(contacts.begin(), contacts.end(), pushes_moving_element);
}

void find_base_reactions(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory) {
    if (scene.tilts()) return find_plastic_moments(scene, by, state, memory);
    find_limits(scene, by.pressed, memory.kick, memory.segments.limits);
    list_slabs(scene, by, state, memory);
    memory.segments.motions.resize(state.moving_elements.size());
    memory.kick.on_base.resize(state.moving_elements.size());
    memory.kick.on_pins.assign(state.moving_elements.size(), {});
    if (!is_pinned(scene) || state.moving_elements.size() == 1) return find_loose_friction(scene, memory);
    list_pins(scene, state, memory.segments.pins);
    find_pinned_friction(by, memory);
}

void move_elements(const Scene& scene, const KickMemory& memory, State& state) {
    if (scene.tilts()) return move_posts(scene, memory.posts, state);
    // Fraction of the speed that friction can remove from a segment, below which a remaining speed is rounding.
    constexpr double left_over = 1e-4;
    for (std::size_t i = 0; i < state.moving_elements.size(); ++i) {
        const MovingElement& element = scene.barrier->moving_elements[i];
        const Vec3& motion = memory.segments.motions[i];
        BodyState& body = state.moving_elements[i];
        const double fastest =
            motion.head<2>().norm() + std::abs(motion.z()) * element.corner[0].head<2>().norm();
        const bool rests = fastest <= left_over * element.body.inverse_mass * memory.segments.limits[i];
        body.velocity = body.angular_momentum = Vec3::Zero();
        if (rests) continue;
        body.velocity.head<2>() = motion.head<2>();
        body.angular_momentum.z() = element.body.inertia(2, 2) * motion.z();
    }
}

std::size_t add_pin_rows(const Scene& scene, const State& state, const KickMemory& memory,
                         std::vector<RigidContact>& rows) {
    if (!is_pinned(scene) || state.moving_elements.size() == 1) return 0;
    const std::size_t before = rows.size(), first = scene.vehicle->joints.size();
    const std::size_t units = state.units.size();
    for (std::size_t i = 0; i + 1 < state.moving_elements.size(); ++i) {
        if (!memory.segments.chain.is_awake(i) || !memory.segments.chain.is_awake(i + 1)) continue;
        const std::size_t row = rows.size();
        find_joint_rows(scene.joints[first + i], first + i, state.moving_elements[i],
                        state.moving_elements[i + 1], rows);
        const auto motion_at = [&](std::size_t element, const Vec3& arm) {
            const Vec3& motion = memory.segments.motions[element];
            return Vec3(motion.x() - arm.y() * motion.z(), motion.y() + arm.x() * motion.z(), 0.0);
        };
        for (std::size_t r = row; r < rows.size(); ++r)
            rows[r].target = rows[r].normal.dot(motion_at(rows[r].body - units, rows[r].arm) -
                                                motion_at(rows[r].body + 1 - units, rows[r].other_arm));
    }
    return rows.size() - before;
}

}  // namespace birm3d
