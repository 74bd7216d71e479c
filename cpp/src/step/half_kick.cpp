#include "step/half_kick.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "birm3d/base/tolerances.hpp"
#include "contact/drift_targets.hpp"
#include "contact/impulse_iteration.hpp"
#include "contact/rigid_contacts.hpp"
#include "contact/rigid_impact.hpp"
#include "kernels/impulse.hpp"
#include "kernels/integrate.hpp"
#include "kernels/suspension.hpp"
#include "scene/bodies.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

// Rounding of the gap of a tyre that stands on the ground (m).
constexpr double rounding_gap = 1e-12;

// After the drift, contacts stop the approach, and both bodies have the same velocity at a joint. Removes the contacts
// that do not act.
void keep_lasting_contacts(double dt, double gravity, const std::vector<ContactImpulses>& before_drift,
                           std::span<const ContactBody> bodies, std::vector<RigidContact>& contacts) {
    // A tyre that is too high to land within a step is left out. If this half of a step stopped it, short steps would
    // keep it above the ground: their first halves would carry nothing, and their second ones twice the load.
    const double tire_gap = std::clamp(0.5 * gravity * dt * dt, rounding_gap, tolerance::touching_gap);
    std::erase_if(contacts, [&](const RigidContact& contact) {
        if (contact.bilateral) return false;
        const bool is_tire = contact.source == ContactSource::tire;
        // A rigid contact of a tyre that carried load before the drift still does. Rotation may have opened a gap of
        // rounding size. It makes an impact only if it approached before the forces of this step.
        const ContactImpulses& before = before_drift[contact.body];
        if (is_tire && before.tire[contact.index] > before.sprung[contact.index]) return contact.is_impact;
        return contact.gap > (is_tire ? tire_gap : tolerance::touching_gap) ||
               approaches_hard(contact, bodies);
    });
}

// Time until the first approaching contact reaches its surface at an impact speed (s). An approach that only the
// forces of this step cause is resting contact if it ends within `negligible` (s). It makes no impact.
double time_to_impact(double negligible, std::span<const ContactBody> bodies,
                      const std::vector<RigidContact>& contacts) {
    double earliest = infinity;
    for (const RigidContact& contact : contacts) {
        if (!(contact.gap > tolerance::touching_gap) || !approaches_hard(contact, bodies)) continue;
        const double time = -contact.gap / separation_velocity(contact, bodies);
        if (contact.is_impact || time > negligible) earliest = std::min(earliest, time);
    }
    return earliest;
}

// Dampers need the velocity at that end of the step. After the drift it is predicted: the second half of the step changes it as
// the first one did. So damping has an error of second order.
void find_sprung_wheels(const Scene& scene, const State& state, Stage stage, KickMemory& memory) {
    if (!scene.settings.ground) return;
    if (stage == Stage::before_drift) memory.motions.start = memory.motions.before;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        if (!has_springs(scene.vehicle->units[u])) continue;
        Twist motion = memory.motions.before[u];
        motion.velocity += motion.velocity - memory.motions.start[u].velocity;
        motion.angular_velocity += motion.angular_velocity - memory.motions.start[u].angular_velocity;
        find_suspension_loads(scene.vehicle->units[u], state.units[u].body, motion, state.units[u].given_way,
                              memory.sprung[u]);
    }
}

// Impulse of a sprung wheel on its unit, about the mass centre.
Wrench add_spring_impulse(const SuspensionLoad& load, double half, ContactImpulses& sums) {
    const double size = half * (load.spring + load.damper);
    sums.tire[load.wheel] += size;
    sums.sprung[load.wheel] += size;
    const Vec3 impulse = size * Vec3::UnitZ();
    return {impulse, load.arm.cross(impulse)};
}

// Energy that dampers take, by the mean of the velocities before and after the half kick.
void add_damper_work(const std::vector<std::vector<SuspensionLoad>>& sprung, const std::vector<Twist>& before,
                     const std::vector<Twist>& after, double half, Energies& energies) {
    for (std::size_t u = 0; u < sprung.size(); ++u)
        for (const SuspensionLoad& load : sprung[u]) {
            const Vec3 force = half * load.damper * Vec3::UnitZ();
            energies.dampers -= power({force, load.arm.cross(force)}, mean(before[u], after[u]));
        }
}

// Applies half a step of contact loads, weight and suspension to all bodies.
// Returns the impulse with which each moving element presses on the ground (N s).
Column kick_by_forces(const Scene& scene, Stage stage, double half, Trial& trial) {
    Column pressed(trial.state.moving_elements.size());
    for (std::size_t i = 0; i < pressed.size(); ++i)
        pressed[i] = half * scene.barrier->moving_elements[i].body.mass * scene.settings.gravity;
    for (std::size_t u = 0; u < trial.state.units.size(); ++u) {
        const RigidBody& body = scene.vehicle->units[u].body;
        UnitState& unit = trial.state.units[u];
        Wrench impulse;
        for (const ContactLoad& contact : unit.contact_loads) {
            Load load = scaled(contact.history.now, half);
            load += stage == Stage::before_drift
                        ? contact.higher_order.predictor
                        : difference(contact.higher_order.corrector, contact.higher_order.predictor);
            impulse += load.wrench;
            const int element = body_of_obstacle(scene, contact.obstacle);
            if (element < 0) continue;
            kick_body(scene, static_cast<std::size_t>(element), reaction_of(load), trial.state);
            pressed[contact.obstacle] += load.wrench.force.z();
        }
        impulse.force.z() -= half * body.mass * scene.settings.gravity;
        for (const SuspensionLoad& load : trial.memory.sprung[u])
            impulse += add_spring_impulse(load, half, trial.impulses[u]);
        kick(body, impulse, unit.body);
    }
    return pressed;
}

// Work of friction, by the mean of the velocities before and after the half kick.
void add_friction_work(const Scene& scene, const std::vector<Twist>& before, const std::vector<Twist>& after,
                       double half, State& state) {
    for (std::size_t u = 0; u < state.units.size(); ++u)
        for (const ContactLoad& contact : state.units[u].contact_loads)
            friction_of(scene, contact.obstacle, state.energies) -=
                half *
                power(contact.friction, relative_motion(scene, state, u, contact.obstacle, before, after));
}

// result = a + factor b
void combine(const std::vector<Twist>& a, double factor, const std::vector<Twist>& b,
             std::vector<Twist>& result) {
    result = a;
    for (std::size_t i = 0; i < a.size(); ++i) {
        result[i].velocity += factor * b[i].velocity;
        result[i].angular_velocity += factor * b[i].angular_velocity;
    }
}

void note_greatest_depth(const std::vector<RigidContact>& contacts, StepStatistics& statistics) {
    for (const RigidContact& contact : contacts)
        if (contact.source == ContactSource::core)
            statistics.deepest_point = std::max(statistics.deepest_point, -contact.gap);
}

// The half kick of bodies that no rigid contact and no moving element constrains.
void kick_unconstrained(const Scene& scene, Stage stage, double half, Trial& trial) {
    State& state = trial.state;
    KickMemory& memory = trial.memory;
    const bool has_friction = std::any_of(state.units.begin(), state.units.end(), [](const UnitState& unit) {
        return std::any_of(
            unit.contact_loads.begin(), unit.contact_loads.end(), [](const ContactLoad& contact) {
                return !contact.friction.force.isZero(0.0) || !contact.friction.torque.isZero(0.0);
            });
    });
    if (has_friction) {
        list_bodies(scene, state, memory.bodies);
        list_motions(state, memory.bodies, memory.motions.before);
    }
    kick_by_forces(scene, stage, half, trial);
    if (!has_friction) return;
    list_motions(state, memory.bodies, memory.motions.pushed);
    add_friction_work(scene, memory.motions.before, memory.motions.pushed, half, state);
}

// Applies the impacts at the start of the step, and sets memory.motions.before to the motions after them. With fixed steps, all
// impacts of the coming step happen at its start, before any point can pass its surface.
void impact_before_drift(const Scene& scene, const StepOptions& options, Trial& trial) {
    KickMemory& memory = trial.memory;
    const double reach = options.locate_impacts ? 0.0 : trial.dt;
    impact_at_once(scene, Stage::before_drift, reach, memory.motions.before, memory.motions.after, trial);
    if (trial.at_start.happened) std::swap(memory.motions.before, memory.motions.after);
}

// Impulses of rigid contacts before the drift: they keep points from passing their surfaces, and close joints.
void kick_rigid_contacts_before(const Scene& scene, const Column& pressed, Trial& trial) {
    KickMemory& memory = trial.memory;
    set_drift_targets(trial.dt, memory.bodies, trial.state, memory.kick.contacts);
    const KickedBy by{.pressed = pressed,
                      .at_end = memory.motions.before,
                      .from = memory.motions.before,
                      .time = 0.5 * trial.dt,
                      .drift = trial.dt};
    kick_towards_closed_joints(scene, by, memory, trial.state);
}

// Impulses of rigid contacts after the drift: they stop what still approaches. Tyre friction needs the velocity at the end of
// the step. The contacts' change of velocity until then is taken to be that before the drift.
void kick_rigid_contacts_after(const Scene& scene, const Column& pressed, Trial& trial) {
    KickMemory& memory = trial.memory;
    keep_lasting_contacts(trial.dt, scene.settings.gravity, trial.impulses, memory.bodies,
                          memory.kick.contacts);
    combine(memory.motions.pushed, 1.0, trial.by_contacts, memory.motions.rolling);
    const KickedBy by{.pressed = pressed,
                      .at_end = memory.motions.rolling,
                      .from = memory.motions.before,
                      .time = 0.5 * trial.dt};
    kick_by_contacts(scene, by, memory, trial.state);
}

// Adds what the half kick did to the impulses of the step and to the energy balance.
void book_half_kick(const Scene& scene, double half, Trial& trial) {
    State& state = trial.state;
    KickMemory& memory = trial.memory;
    add_friction_work(scene, memory.motions.before, memory.motions.after, half, state);
    add_damper_work(memory.sprung, memory.motions.before, memory.motions.after, half, state.energies);
    book_contacts(scene, memory.kick, memory.motions.before, memory.motions.after, state);
}

}  // namespace

void half_kick(const Scene& scene, Stage stage, const StepOptions& options, Trial& trial) {
    State& state = trial.state;
    KickMemory& memory = trial.memory;
    const double half = 0.5 * trial.dt;
    const bool is_first = stage == Stage::before_drift;
    find_rigid_contacts(scene, state, trial.dt, options, memory);
    if (memory.contacts.empty() && state.moving_elements.empty())
        return kick_unconstrained(scene, stage, half, trial);

    list_bodies(scene, state, memory.bodies);
    list_motions(state, memory.bodies, memory.motions.before);
    if (is_first)
        impact_before_drift(scene, options, trial);
    else
        note_greatest_depth(memory.contacts, state.statistics);

    for (RigidContact& contact : memory.contacts)
        contact.is_impact = approaches_hard(contact, memory.bodies);
    find_sprung_wheels(scene, state, stage, memory);
    const Column pressed = kick_by_forces(scene, stage, half, trial);
    list_motions(state, memory.bodies, memory.motions.pushed);
    if (is_first && options.locate_impacts)
        trial.impact_after =
            time_to_impact(tolerance::resting_approach * trial.dt, memory.bodies, memory.contacts);
    if (trial.impact_within()) return;

    memory.kick.contacts = memory.contacts;
    if (is_first)
        kick_rigid_contacts_before(scene, pressed, trial);
    else
        kick_rigid_contacts_after(scene, pressed, trial);
    add_impulses(scene, state, memory.kick, trial.impulses, trial.joint_impulses);
    list_motions(state, memory.bodies, memory.motions.after);
    if (is_first) combine(memory.motions.after, -1.0, memory.motions.pushed, trial.by_contacts);
    book_half_kick(scene, half, trial);

    if (!is_first) impact_at_once(scene, stage, 0.0, memory.motions.after, memory.motions.before, trial);
}

}  // namespace birm3d
