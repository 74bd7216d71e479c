#include "birm3d/step/step.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/contact/skin_contact.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/scene/bodies.hpp"
#include "birm3d/step/half_kick.hpp"
#include "birm3d/step/structure_load.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Radius of gyration (m).
double gyration(const RigidBody& body) {
    return std::sqrt(0.5 * body.inertia.trace() * body.inverse_mass);
}

// What a load pushes on: a unit, and the segment that takes the other side, or null where that is fixed.
struct Pushed {
    Pushed(const RigidBody& body_, const BodyState& state)
        : body(body_),
          gyration(birm3d::gyration(body_)),
          inverse_inertia(inverse_inertia_in_world(body_, state)) {}

    const RigidBody& body;
    double gyration;
    Mat3 inverse_inertia;  // world axes
    const Segment* segment = nullptr;
};

// A slope that changes within the step costs up to an eighth of the departure it makes (m/s).
double error_of(const Pushed& pushed, const Load& departure, double dt) {
    const double force = departure.wrench.force.norm();
    const Vec3 turning = pushed.inverse_inertia * departure.wrench.torque;
    double change = pushed.body.inverse_mass * force + pushed.gyration * turning.norm();
    if (const Segment* segment = pushed.segment) {
        const double turn = segment->body.inverse_inertia(2, 2) * std::abs(departure.reaction_torque.z());
        change += segment->body.inverse_mass * force + segment->half_length * turn;
    }
    return dt / 8.0 * change;
}

// What a bend of one adds over a step of dt that follows one of h: to the lead, and with the new bend's change to
// the kick (s^3).
double cubic_weight(double dt, double h) {
    return dt * dt * (dt / 12.0 + h / 6.0);
}

// Before the new load is known: the integral of (1 - s/dt) times the load's course, less that of a constant.
Load lead(const LoadCourse& before, double dt) {
    Load sum = scaled(before.rate, dt * dt / 6.0);
    if (before.bend_lasts) sum += scaled(before.bend, cubic_weight(dt, before.step));
    return sum;
}

// A wall does not pull: the parabola of the normal force stays above zero while its bend is at most
// (sqrt(F0) + sqrt(F1))^2. Share of a correction that this allows.
double share_that_pushes(const Load& correction, const LoadCourse& before, const LoadCourse& now, double dt) {
    const double bend = -6.0 / dt * correction.normal_force;
    const double root = std::sqrt(before.now.normal_force) + std::sqrt(now.now.normal_force);
    return bend > root * root ? root * root / bend : 1.0;
}

bool is_telling(double dt, const LoadCourse& before) {
    return !(before.lapse + dt < tolerance::telling_step * before.step);
}

// The course after a step of dt to `load`.
LoadCourse course_to(const Load& load, const LoadCourse& before, double dt) {
    LoadCourse now = before;
    now.now = load;
    now.lapse = is_telling(dt, before) ? 0.0 : before.lapse + dt;
    if (now.lapse > 0.0) return now;
    now.step = dt;
    now.step_before = before.step;
    now.rate = scaled(difference(load, before.now), 1.0 / dt);
    now.bend = scaled(difference(now.rate, before.rate), 1.0 / (dt + before.step));
    return now;
}

// How far the end of the step lies from a straight line, and from a parabola.
Load departure(const LoadCourse& before, const LoadCourse& now) {
    return scaled(difference(now.rate, before.rate), now.step);
}
Load change(const LoadCourse& before, const LoadCourse& now) {
    return scaled(difference(now.bend, before.bend), now.step * (now.step + before.step));
}

// Of the whole step, impulses. A cubic follows the change of the bend, where the bend lasts. At a corner it does not,
// and a bend of the last step that was a corner says nothing of this one.
Load correction(const LoadCourse& before, const LoadCourse& now) {
    const double dt = now.step, span = dt + before.step;
    Load sum = scaled(departure(before, now), -dt * dt / (6.0 * span));
    if (before.bend_lasts)
        sum += scaled(change(before, now),
                      -cubic_weight(dt, before.step) / (span * (span + before.step_before)));
    return sum;
}

// The loads of the touches of one structure at the new instant, their courses, and what the higher order adds to the
// trapezoid rule. Returns the estimated error of the step's velocity (m/s). What depends on signs and sizes is decided by
// the structure's load as a whole; the rest is linear in the load.
double load_and_correct(const Pushed& pushed, const LoadCourse& before, double dt,
                        std::span<const LoadCourse> befores, std::span<const Load> loads,
                        std::span<Touch> touches) {
    Load total;
    for (std::size_t i = 0; i < touches.size(); ++i) {
        total += loads[i];
        touches[i].course = {};
        touches[i].course.now = loads[i];
        touches[i].extra = {lead(befores[i], dt), {}};
    }
    // Where nothing presses any more, the rate ends with the load: a straight line is the better course
    // through the corner that a release makes.
    if (total.normal_force == 0.0) return error_of(pushed, difference(total, before.now), dt);

    LoadCourse now = course_to(total, before, dt);
    const double by_departure = error_of(pushed, departure(before, now), dt);
    const double by_change = error_of(pushed, change(before, now), dt);
    if (is_telling(dt, before))
        now.bend_lasts = before.step > 0.0 && by_change < tolerance::lasting_bend * by_departure;
    const double pushing = share_that_pushes(correction(before, now), before, now, dt);
    for (std::size_t i = 0; i < touches.size(); ++i) {
        touches[i].course = course_to(loads[i], befores[i], dt);
        touches[i].course.bend_lasts = now.bend_lasts;
        touches[i].extra.correction = correction(befores[i], touches[i].course);
        if (pushing < 1.0) touches[i].extra.correction = scaled(touches[i].extra.correction, pushing);
    }
    return std::min(by_departure, by_change);
}

const LoadCourse& course_at(const std::vector<Touch>& touches, std::size_t obstacle) {
    static const LoadCourse none;
    for (const Touch& touch : touches)
        if (touch.obstacle == obstacle) return touch.course;
    return none;
}

// Load of a touch as both sides feel it: what turns the unit about its mass centre turns the obstacle about its own
// point, the other way.
Load load_of(const Scene& scene, const State& state, const BodyState& body, const Touch& touch) {
    Wrench wrench = touch.contact;
    wrench += touch.friction;
    const Vec3 arm = body.position - pose_of(scene, touch.obstacle, state).position;
    return {wrench, -wrench.torque - arm.cross(wrench.force), touch.normal_force};
}

// Returns the estimated error of the step's velocity (m/s).
double correct(const Scene& scene, std::size_t u, const UnitState& from, Trial& trial) {
    UnitState& moved = trial.state.units[u];
    const std::span<Touch> touches(moved.touches);
    if (touches.empty()) return 0.0;
    Pushed pushed(scene.vehicle->units[u].body, moved.body);
    std::vector<LoadCourse>& befores = trial.courses;
    std::vector<Load>& loads = trial.loads;
    double error = 0.0;
    for (std::size_t i = 0, end = 0; i < touches.size(); i = end) {
        end = end_of_structure(scene, touches, i);
        const LoadCourse before =
            course_of_structure(scene, from.touches, scene.obstacles[touches[i].obstacle].structure);
        befores.clear();
        loads.clear();
        for (const Touch& touch : touches.subspan(i, end - i)) {
            LoadCourse own = course_at(from.touches, touch.obstacle);
            own.step = before.step, own.step_before = before.step_before, own.lapse = before.lapse;
            own.bend_lasts = before.bend_lasts;
            befores.push_back(own);
            loads.push_back(load_of(scene, trial.state, moved.body, touch));
        }
        pushed.segment = touches[i].obstacle < scene.free_segments()
                             ? &scene.barrier->segments[touches[i].obstacle]
                             : nullptr;
        error += load_and_correct(pushed, before, trial.dt, befores, loads, touches.subspan(i, end - i));
    }
    return error;
}

bool skin_touches_barrier(const Scene& scene, const UnitState& unit) {
    return std::any_of(unit.touches.begin(), unit.touches.end(), [&](const Touch& touch) {
        return touch.obstacle != scene.ground && touch.normal_force > 0.0;
    });
}

// By how much a segment that gives way adds to the inverse effective mass of a contact, at the most: it is pushed at its
// end.
double share_of_segments(const Scene& scene, const RigidBody& body, const std::vector<Touch>& touches) {
    double most = 0.0;
    for (const Touch& touch : touches) {
        if (!(touch.obstacle < scene.free_segments()) || !(touch.normal_force > 0.0)) continue;
        const Segment& segment = scene.barrier->segments[touch.obstacle];
        const Vec3& end = segment.corner[0];
        most =
            std::max(most, body.mass * (segment.body.inverse_mass + (end.x() * end.x() + end.y() * end.y()) *
                                                                        segment.body.inverse_inertia(2, 2)));
    }
    return most;
}

// Infinite where nothing pushes.
double critical_step(const Scene& scene, const RigidBody& body, const UnitState& unit) {
    const double stiffness = unit.skin.stiffness * (1.0 + share_of_segments(scene, body, unit.touches));
    return stiffness > 0.0 ? tolerance::critical_phase / std::sqrt(stiffness) : infinity;
}

// What is left of a velocity v that turns by phi in a step of second order: v phi^3/12.
double missed_share(double turn) {
    return turn * turn * turn / 12.0;
}

// Of the turning itself, which the drift follows to second order (m/s).
double turning_error(const Scene& scene, const State& state, double dt) {
    double most = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const RigidBody& body = scene.vehicle->units[u].body;
        const double omega = angular_velocity(body, state.units[u].body).norm();
        most = std::max(most, missed_share(omega * dt) * omega * gyration(body));
    }
    return most;
}

// A joint's force turns with its bodies, which the half kicks follow to second order: of a velocity omega r that
// turns by phi = omega dt they miss about phi^3/12 (m/s).
double joint_error(const Scene& scene, const State& state, double dt) {
    double most = 0.0;
    for (const Joint& joint : scene.joints) {
        const auto spin = [&](std::size_t body) {
            const BodyState& of = body_state(state, body);
            return of.angular_momentum.isZero(0.0) ? 0.0
                                                   : angular_velocity(rigid_body(scene, body), of).norm();
        };
        const double omega = std::max(spin(joint.leading), spin(joint.trailing));
        const double lever = joint.place_on_leading.norm() + joint.place_on_trailing.norm();
        most = std::max(most, missed_share(omega * dt) * omega * lever);
    }
    return most;
}

void note_climbing(Trial& trial) {
    trial.climbing.clear();
    for (const UnitState& unit : trial.state.units)
        trial.climbing.push_back(unit.body.velocity.z());
}

// The weight works along the drift, and in the half kicks as the mean of the motions beside them. Where contacts open and
// close these differ: the velocity that the missing energy is at the speed of the scene (m/s).
double weight_error(const Scene& scene, const State& from, const Trial& trial) {
    double most = 0.0;
    for (std::size_t u = 0; u < from.units.size(); ++u) {
        const Impact &first = trial.at_start, &last = trial.at_end;
        const BodyState& before = first.happened ? first.bodies[u] : from.units[u].body;
        const BodyState& after = last.happened ? last.bodies[u] : trial.state.units[u].body;
        const double bend = before.velocity.z() - 2.0 * trial.climbing[u] + after.velocity.z();
        most = std::max(most, std::abs(bend));
    }
    return 0.5 * trial.dt * scene.settings.gravity * most / scene.reference_speed();
}

void clear(ContactImpulses& impulses) {
    std::fill(impulses.tire.begin(), impulses.tire.end(), 0.0);
    impulses.tire_friction = Vec3::Zero();
    impulses.obstacles.clear();
    impulses.barrier_normal = 0.0;
    impulses.member_contacts = 0;
    impulses.joints = Vec3::Zero();
}

void begin(const State& from, double dt, Trial& trial) {
    static_cast<Progress&>(trial.state) = from;
    trial.state.segments = from.segments;
    trial.state.time += dt;
    trial.dt = dt;
    trial.error = 0.0;
    trial.critical_step = trial.impact_after = infinity;
    trial.at_start.happened = trial.at_end.happened = false;
    trial.by_contacts.assign(body_count(from), Twist{});
    trial.seen.clear();
    for (std::size_t u = 0; u < from.units.size(); ++u) {
        static_cast<UnitMotion&>(trial.state.units[u]) = from.units[u];
        trial.active[u].clear();
        clear(trial.impulses[u]);
        clear(trial.at_start.impulses[u]);
        clear(trial.at_end.impulses[u]);
        for (Touch& touch : trial.state.units[u].touches)
            touch.extra = {lead(touch.course, dt), {}};
    }
    for (auto* sums : {&trial.joint_impulses, &trial.at_start.joint_impulses, &trial.at_end.joint_impulses})
        std::fill(sums->begin(), sums->end(), Wrench{});
}

void book_trusses(State& now) {
    now.energies.stored = 0.0;
    for (const UnitState& unit : now.units) {
        now.energies.stored += unit.skin.stored;
        now.truss_work += unit.skin.work;
    }
    now.energies.crushed = now.truss_work - now.energies.stored;
}

void book_motion(const Scene& scene, State& now) {
    now.energies.kinetic = 0.0;
    for (std::size_t body = 0; body < body_count(now); ++body)
        now.energies.kinetic += kinetic_energy(rigid_body(scene, body), body_state(now, body));
}

}  // namespace

Trial::Trial(const Vehicle& vehicle) : state(vehicle) {
    for (const Unit& unit : vehicle.units) {
        impulses.emplace_back(unit.wheels.size());
        active.emplace_back(unit.trusses.blocks);
        stale.emplace_back(unit.trusses.blocks);
    }
    at_start.impulses = at_end.impulses = impulses;
    joint_impulses.resize(vehicle.joints.size());
    at_start.joint_impulses = at_end.joint_impulses = joint_impulses;
}

void Trial::restart(const Vehicle& vehicle, const State& beside) {
    for (std::size_t u = 0; u < stale.size(); ++u) {
        state.units[u].trusses.reset(vehicle.units[u].trusses);
        stale[u].clear();
        for (const std::size_t block : beside.units[u].trusses.met())
            stale[u].add(block);
    }
}

namespace {

// Of the sums over lasting contacts and impacts of any unit.
template <class Is>
bool any_sum(const Trial& trial, const Is& is) {
    return std::any_of(trial.impulses.begin(), trial.impulses.end(), is) ||
           std::any_of(trial.at_start.impulses.begin(), trial.at_start.impulses.end(), is) ||
           std::any_of(trial.at_end.impulses.begin(), trial.at_end.impulses.end(), is);
}

}  // namespace

bool Trial::body_rests() const {
    return body_held() || any_sum(*this, [](const ContactImpulses& sum) {
               return std::any_of(sum.tire.begin(), sum.tire.end(),
                                  [](double impulse) { return impulse > 0.0; });
           });
}

bool Trial::body_held() const {
    return any_sum(*this, [](const ContactImpulses& sum) { return sum.member_contacts > 0; });
}

bool Trial::body_held_by_barrier() const {
    return any_sum(*this, [](const ContactImpulses& sum) { return sum.barrier_normal > 0.0; });
}

void try_step(const Scene& scene, const State& from, double dt, const StepOptions& options, Trial& trial) {
    State& now = trial.state;
    begin(from, dt, trial);
    half_kick(scene, Stage::before_drift, options, trial);
    if (trial.impact_within()) return;
    note_climbing(trial);

    for (std::size_t i = 0; i < now.segments.size(); ++i)
        drift(scene.barrier->segments[i].body, dt, now.segments[i]);
    for (std::size_t u = 0; u < now.units.size(); ++u) {
        const Unit& unit = scene.vehicle->units[u];
        UnitState& moved = now.units[u];
        now.energies.potential += dt * unit.body.mass * scene.settings.gravity * moved.body.velocity.z();
        drift(unit.body, dt, moved.body);

        if (!scene.obstacles.empty()) skin_forces(scene, u, from, trial);
        if (skin_touches_barrier(scene, moved)) now.touched = true;

        trial.error = std::max(trial.error, correct(scene, u, from.units[u], trial));
        trial.critical_step = std::min(trial.critical_step, critical_step(scene, unit.body, moved));
    }

    book_trusses(now);
    trial.error = std::max(trial.error, joint_error(scene, now, dt));
    trial.error = std::max(trial.error, turning_error(scene, now, dt));

    half_kick(scene, Stage::after_drift, options, trial);
    trial.error = std::max(trial.error, weight_error(scene, from, trial));
    book_motion(scene, now);
    // A post between nodes meets nothing but the rigid body.
    if (trial.body_held_by_barrier()) now.touched = true;
}

namespace {

// Of the barrier's elements, those that are near for the first time.
void note_near(std::size_t obstacle, State& state) {
    if (obstacle >= state.was_near.size() || state.was_near[obstacle] != 0) return;
    state.was_near[obstacle] = 1;
    ++state.statistics.near_elements;
}

void count(const Trial& trial, State& state) {
    StepStatistics& statistics = state.statistics;
    statistics.steps += 1;
    statistics.shortest_step = std::min(statistics.shortest_step, trial.dt);
    statistics.longest_step = std::max(statistics.longest_step, trial.dt);
    statistics.least_critical_step = std::min(statistics.least_critical_step, trial.critical_step);
    if (std::all_of(trial.active.begin(), trial.active.end(),
                    [](const BlockSet& active) { return active.blocks().empty(); })) {
        ++statistics.free_steps;
        statistics.free_time += trial.dt;
    }
    for (const std::size_t obstacle : trial.seen)
        note_near(obstacle, state);
    for (std::size_t u = 0; u < trial.impulses.size(); ++u) {
        const ContactImpulses* const sums[] = {&trial.impulses[u], &trial.at_start.impulses[u],
                                               &trial.at_end.impulses[u]};
        for (const ContactImpulses* sum : sums)
            for (const ObstacleImpulse& on : sum->obstacles)
                if (on.impulse != Vec3::Zero()) note_near(on.obstacle, state);
        for (std::size_t w = 0; w < trial.impulses[u].tire.size(); ++w)
            statistics.wheels_on_ground += std::any_of(std::begin(sums), std::end(sums),
                                                       [w](const auto* sum) { return sum->tire[w] > 0.0; });
    }
    statistics.body_steps += trial.body_held();
}

}  // namespace

void accept(const Scene& scene, Trial& trial, State& state) {
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        UnitState& to = state.units[u];
        UnitState& with = trial.state.units[u];
        static_cast<UnitMotion&>(to) = with;
        // Blocks change places, once those that this step did not make are brought up to date.
        const std::vector<std::size_t>& active = trial.active[u].blocks();
        for (const std::size_t block : trial.stale[u].blocks())
            if (!trial.active[u].contains(block)) with.trusses.block[block] = to.trusses.block[block];
        std::swap(to.trusses.block, with.trusses.block);
        trial.stale[u] = trial.active[u];
        if (active.empty()) continue;
        to.trusses.group(scene.vehicle->units[u].trusses, active);
    }
    static_cast<Progress&>(state) = trial.state;
    state.segments = trial.state.segments;
    count(trial, state);
}

}  // namespace birm3d
