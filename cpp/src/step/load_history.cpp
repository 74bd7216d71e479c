#include "step/load_history.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "birm3d/base/tolerances.hpp"
#include "scene/obstacles.hpp"
#include "step/error_estimates.hpp"
#include "step/structure_load.hpp"

namespace birm3d {

namespace {

// Factor of W'' in the predictor of a step of dt that follows a step of h (s^3).
double cubic_weight(double dt, double h) {
    return dt * dt * (dt / 12.0 + h / 6.0);
}

// Is the time since the last difference long enough for a new one? Differences over very short steps are noise.
bool is_informative(double dt, const LoadHistory& before) {
    return !(before.time_since + dt < tolerance::min_informative_step * before.step);
}

// The history after a step of dt that ends with `load`.
LoadHistory extended(const LoadHistory& before, const Load& load, double dt) {
    LoadHistory now = before;
    now.now = load;
    now.time_since = is_informative(dt, before) ? 0.0 : before.time_since + dt;
    if (now.time_since > 0.0) return now;
    now.step = dt;
    now.previous_step = before.step;
    now.rate = scaled(difference(load, before.now), 1.0 / dt);
    now.second_difference = scaled(difference(now.rate, before.rate), 1.0 / (dt + before.step));
    return now;
}

// Distance of the new load from the straight line through the two before.
Load departure_from_line(const LoadHistory& before, const LoadHistory& now) {
    return scaled(difference(now.rate, before.rate), now.step);
}

// Distance of the new load from the parabola through the three before.
Load departure_from_parabola(const LoadHistory& before, const LoadHistory& now) {
    return scaled(difference(now.second_difference, before.second_difference),
                  now.step * (now.step + before.step));
}

// Impulse C. The cubic term is used only where the history is smooth: after a corner, W'' says nothing of this step.
Load corrector(const LoadHistory& before, const LoadHistory& now) {
    const double dt = now.step, span = dt + before.step;
    Load sum = scaled(departure_from_line(before, now), -dt * dt / (6.0 * span));
    if (before.is_smooth)
        sum += scaled(departure_from_parabola(before, now),
                      -cubic_weight(dt, before.step) / (span * (span + before.previous_step)));
    return sum;
}

// A barrier can not pull. The parabola of the normal force over the step stays above zero while its curvature is at
// most (sqrt(F0) + sqrt(F1))^2. Returns the fraction of the corrector that this allows.
double compressive_fraction(const Load& corrector, const LoadHistory& before, const LoadHistory& now,
                            double dt) {
    const double curvature = -6.0 / dt * corrector.normal_force;
    const double root = std::sqrt(before.now.normal_force) + std::sqrt(now.now.normal_force);
    return curvature > root * root ? root * root / curvature : 1.0;
}

// The contacts of one structure: their load histories at the start of the step and their loads at its end.
struct StructureStep {
    const LoadHistory& before;             // of the structure as a whole
    std::span<const LoadHistory> befores;  // of each contact
    std::span<const Load> loads;           // the same, at the end of the step
    double dt;                             // s
};

// Decisions that depend on signs and magnitudes are made for the structure as a whole; all else is linear in the load
// and is done for each contact. Returns the estimated error of the velocity (m/s).
double correct_structure(const EffectiveInertia& inertia, const StructureStep& step,
                         std::span<ContactLoad> contacts) {
    const double dt = step.dt;
    Load total;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        total += step.loads[i];
        contacts[i].history = {};
        contacts[i].history.now = step.loads[i];
        contacts[i].higher_order = {predictor(step.befores[i], dt), {}};
    }
    // A release is a corner of the load: the straight line to zero is the better interpolation, so no corrector.
    if (total.normal_force == 0.0) return velocity_error(inertia, difference(total, step.before.now), dt);

    LoadHistory now = extended(step.before, total, dt);
    const double by_line = velocity_error(inertia, departure_from_line(step.before, now), dt);
    const double by_parabola = velocity_error(inertia, departure_from_parabola(step.before, now), dt);
    if (is_informative(dt, step.before))
        now.is_smooth = step.before.step > 0.0 && by_parabola < tolerance::smooth_change * by_line;
    const double fraction = compressive_fraction(corrector(step.before, now), step.before, now, dt);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        LoadHistory& history = contacts[i].history;
        history = extended(step.befores[i], step.loads[i], dt);
        history.is_smooth = now.is_smooth;
        contacts[i].higher_order.corrector = corrector(step.befores[i], history);
        if (fraction < 1.0)
            contacts[i].higher_order.corrector = scaled(contacts[i].higher_order.corrector, fraction);
    }
    return std::min(by_line, by_parabola);
}

const LoadHistory& history_at(const std::vector<ContactLoad>& contacts, std::size_t obstacle) {
    static const LoadHistory none;
    for (const ContactLoad& contact : contacts)
        if (contact.obstacle == obstacle) return contact.history;
    return none;
}

// Load of a contact as both sides feel it: the reaction torque on the obstacle is about the obstacle's own origin.
Load load_of(const Scene& scene, const State& state, const BodyState& body, const ContactLoad& contact) {
    Wrench wrench = contact.contact;
    wrench += contact.friction;
    const Vec3 arm = body.position - pose_of(scene, contact.obstacle, state).position;
    return {wrench, -wrench.torque - arm.cross(wrench.force), contact.normal_force};
}

}  // namespace

Load predictor(const LoadHistory& before, double dt) {
    Load sum = scaled(before.rate, dt * dt / 6.0);
    if (before.is_smooth) sum += scaled(before.second_difference, cubic_weight(dt, before.step));
    return sum;
}

double correct_loads(const Scene& scene, std::size_t u, const UnitState& from, Trial& trial) {
    UnitState& moved = trial.state.units[u];
    const std::span<ContactLoad> contacts(moved.contact_loads);
    if (contacts.empty()) return 0.0;
    EffectiveInertia inertia(scene.vehicle->units[u].body, moved.body);
    std::vector<LoadHistory>& befores = trial.histories;
    std::vector<Load>& loads = trial.loads;
    double error = 0.0;
    for (std::size_t i = 0, end = 0; i < contacts.size(); i = end) {
        end = end_of_structure(scene, contacts, i);
        const std::span<ContactLoad> joined = contacts.subspan(i, end - i);
        const LoadHistory before = history_of_structure(scene, from.contact_loads,
                                                        scene.obstacles[joined.front().obstacle].structure);
        befores.clear();
        loads.clear();
        for (const ContactLoad& contact : joined) {
            LoadHistory& history = befores.emplace_back(history_at(from.contact_loads, contact.obstacle));
            history.step = before.step;
            history.previous_step = before.previous_step;
            history.time_since = before.time_since;
            history.is_smooth = before.is_smooth;
            loads.push_back(load_of(scene, trial.state, moved.body, contact));
        }
        // A post that yields is so light that it follows the vehicle: the error is that of the vehicle.
        const bool slides = scene.slides() && joined.front().obstacle < scene.moving_count();
        inertia.segment = slides ? &scene.barrier->moving_elements[joined.front().obstacle] : nullptr;
        error += correct_structure(inertia, {before, befores, loads, trial.dt}, joined);
    }
    return error;
}

}  // namespace birm3d
