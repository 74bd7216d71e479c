// Normal impulses and friction depend on each other. They are computed alternately until they converge.
#include "contact/impulse_iteration.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "contact/base_reactions.hpp"
#include "contact/post_tilting.hpp"
#include "contact/rigid_friction.hpp"
#include "kernels/integrate.hpp"
#include "kernels/joints.hpp"
#include "scene/bodies.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

bool any_sprung(const KickMemory& memory) {
    return std::any_of(memory.sprung.begin(), memory.sprung.end(),
                       [](const std::vector<SuspensionLoad>& loads) { return !loads.empty(); });
}

// Have the normal impulses converged since the last round? Stores them for the next one.
bool has_converged(const std::vector<RigidContact>& contacts, Column& last) {
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

// Has what holds the elements at the ground converged since the last round? Stores it for the next one. Free-standing
// segments are held by friction forces, posts that yield by moments.
bool has_converged(const std::vector<Wrench>& on_base, bool tilts, std::vector<Wrench>& last) {
    last.resize(on_base.size());
    double sum = 0.0, change = 0.0;
    for (std::size_t i = 0; i < on_base.size(); ++i) {
        const Vec3 &now = tilts ? on_base[i].torque : on_base[i].force,
                   &before = tilts ? last[i].torque : last[i].force;
        sum += now.norm();
        change = std::max(change, (now - before).norm());
        last[i] = on_base[i];
    }
    // Relative change below which friction counts as converged. At a base corner nearly at rest, rounding decides its
    // direction.
    constexpr double settled = 1e-6;
    return change <= settled * sum;
}

// Sets the motions that the solver starts from: with friction, without normal impulses and pins.
void set_motions_with_friction(const State& state, const ContactKick& kicked,
                               std::vector<ContactBody>& bodies) {
    set_motions(state, bodies);
    const std::size_t units = state.units.size();
    for (std::size_t i = 0; i < kicked.on_base.size(); ++i) {
        ContactBody& body = bodies[units + i];
        Wrench push = kicked.on_base[i];
        push += kicked.on_cores[units + i];
        add_impulse(body, push, body.motion);
    }
}

// Adds the impulses of sliding joints that slide to the motions that the solver starts from.
void add_sliding_impulses(const std::vector<RigidContact>& contacts, std::vector<ContactBody>& bodies) {
    for (const RigidContact& contact : contacts) {
        if (!contact.slides) continue;
        ContactBody& body = bodies[contact.body];
        ContactBody& other = bodies[static_cast<std::size_t>(contact.other)];
        add_impulse(body, wrench_on_body(contact), body.motion);
        add_impulse(other, wrench_on_other(contact), other.motion);
    }
}

// A joint that holds begins to slide where its impulse exceeds its limit over `time` (s). One that slides holds again where
// its impulse would drive the motion. Did any change?
bool decide_sliding(double time, std::span<const ContactBody> bodies, std::vector<RigidContact>& contacts) {
    bool any = false;
    for (RigidContact& contact : contacts) {
        if (!may_slide(contact)) continue;
        const double most = time * contact.most_force;
        if (!contact.slides && std::abs(contact.impulse) > most) {
            contact.slides = any = true;
            contact.impulse = std::copysign(most, contact.impulse);
        } else if (contact.slides && contact.impulse * separation_velocity(contact, bodies) > 0.0) {
            contact.slides = false;
            any = true;
        }
    }
    return any;
}

// If the rigid body meets free-standing segments, the pins between them are rows of the solver, too.
void prepare_solver(const Scene& scene, const State& state, KickMemory& memory) {
    std::erase_if(memory.kick.contacts,
                  [&](const RigidContact& row) { return row.body >= state.units.size(); });
    add_pin_rows(scene, state, memory, memory.kick.contacts);
    memory.iteration.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
}

// Starts an iteration without friction from the present motions. Notes how fast the surfaces move on which bottomed-out
// trusses slide.
void begin_iteration(const State& state, KickMemory& memory) {
    ContactKick& kicked = memory.kick;
    kicked.on_ground.assign(state.units.size(), {});
    kicked.on_cores.assign(memory.bodies.size(), {});
    list_motions(state, memory.bodies, memory.motions.pushed);
    for (RigidContact& contact : kicked.contacts) {
        if (!pushes_moving_element(contact)) continue;
        const Twist& other = sliding_motions(memory)[static_cast<std::size_t>(contact.other)];
        contact.sliding_surface = other.velocity + other.angular_velocity.cross(contact.other_arm);
    }
    memory.iteration.tire.resize(state.units.size());
    memory.iteration.last.clear();
    memory.iteration.on_base.clear();
}

// Finds the normal impulses that belong to the present friction.
void solve_normal_impulses(const Scene& scene, const KickedBy& by, bool meets, const State& state,
                           KickMemory& memory) {
    const bool meets_posts = meets && scene.tilts();
    if (meets) prepare_solver(scene, state, memory);
    // A joint holds, or slides one way or the other; a post stands still or yields. After the last change the impulses are solved
    // for once more.
    const int most_changes = meets_posts ? 10 : 3;
    for (int changes = 0;; ++changes) {
        set_motions_with_friction(state, memory.kick, memory.bodies);
        add_sliding_impulses(memory.kick.contacts, memory.bodies);
        memory.iteration.solver.solve(memory.kick.contacts, memory.bodies);
        if (changes == most_changes) break;
        const bool slides = decide_sliding(by.time, memory.bodies, memory.kick.contacts);
        const bool yields = meets_posts && decide_yielding(scene, by, state, memory);
        if (!slides && !yields) break;
        memory.iteration.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
    }
    sum_tire_impulses(scene, by, memory);
}

// Kicks the units, which have had the friction already, by the normal impulses and those of joints.
void kick_by_normal_impulses(const Scene& scene, ContactKick& kicked, State& state) {
    const std::size_t units = state.units.size();
    std::erase_if(kicked.contacts, [&](const RigidContact& row) { return row.body >= units; });
    for (const RigidContact& contact : kicked.contacts) {
        kick_body(scene, contact.body, wrench_on_body(contact), state);
        const bool on_unit = contact.other >= 0 && contact.other < static_cast<int>(units);
        if (on_unit)
            kick_body(scene, static_cast<std::size_t>(contact.other), wrench_on_other(contact), state);
    }
}

// Finds normal impulses and friction by turns, and kicks the bodies by them. `memory.iteration.solver` is prepared. At given
// friction, the normal impulses j and the relative velocities w after them fulfil
//   w = A j + v >= v_target,  j >= 0,  (w - v_target) . j = 0,
// v: without j, A: change by each unit of j. That is for one contact Eq. 1 of the paper ("Rigid bodies and impulses" in
// docs/pages/theory.md). Friction depends on j. It also
// tips the body, which changes v and so j.
void solve_with_friction(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    ContactKick& kicked = memory.kick;
    begin_iteration(state, memory);
    const bool meets = meets_moving_element(kicked.contacts);
    if (meets) find_base_reactions(scene, by, state, memory);
    const bool meets_posts = meets && scene.tilts();
    if (meets_posts) begin_holding_posts(scene, by, state, memory);
    solve_normal_impulses(scene, by, meets, state, memory);
    find_held_motions(scene, by, memory);
    constexpr int most_rounds = 30;
    for (int round = 0; round < most_rounds; ++round) {
        const bool normal_converged = has_converged(kicked.contacts, memory.iteration.last);
        const bool base_converged =
            !meets || (round > 0 && has_converged(kicked.on_base, scene.tilts(), memory.iteration.on_base));
        if (round > 0 && normal_converged && base_converged) break;
        kick_by_friction(scene, by, memory, state);
        if (meets && !meets_posts) find_base_reactions(scene, by, state, memory);
        if (!meets && !any_friction(kicked)) break;
        solve_normal_impulses(scene, by, meets, state, memory);
    }
    if (meets_posts) free_posts(scene, state, memory);
    kick_by_normal_impulses(scene, kicked, state);
    // An impact that meets no moving element does not change them.
    if (state.moving_elements.empty() || (by.is_impact && !meets)) return;
    find_base_reactions(scene, by, state, memory);
    move_elements(scene, memory, state);
}

// Lowers each joint's target velocity by its gap after the drift over dt. Returns the greatest gap (m).
double correct_targets(const Scene& scene, const State& kicked, double dt,
                       std::vector<RigidContact>& contacts) {
    std::vector<BodyState> bodies;
    list_body_states(kicked, bodies);
    for (std::size_t b = 0; b < bodies.size(); ++b)
        drift(rigid_body(scene, b), dt, bodies[b]);
    double widest = 0.0;
    for (RigidContact& contact : contacts) {
        if (!contact.bilateral || may_slide(contact)) continue;
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
    memory.iteration.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
    solve_with_friction(scene, by, memory, state);
}

void kick_towards_closed_joints(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state) {
    if (scene.vehicle->joints.empty()) return kick_by_contacts(scene, by, memory, state);
    memory.iteration.solver.prepare(memory.kick.contacts, memory.bodies, scene.reference_speed());
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
        solve_with_friction(scene, by, memory, state);
        const double gap = correct_targets(scene, state, by.drift, memory.kick.contacts);
        if (gap <= tolerance::joint_gap || gap >= last) break;
        last = gap;
    }
}

}  // namespace birm3d
