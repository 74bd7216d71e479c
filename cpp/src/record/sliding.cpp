#include "record/sliding.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "kernels/integrate.hpp"
#include "record/position_at_barrier.hpp"
#include "record/rest.hpp"

namespace birm3d {

namespace {

bool may_slide(const Scene& scene, const State& state) {
    return state.touched && state.moving_elements.empty() && !runs_along_line(scene);
}

// Kinetic energy of the vehicle less that of its motion along the line (J).
double other_energy(const Scene& scene, const State& state, const Event& event) {
    double other = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const RigidBody& body = scene.vehicle->units[u].body;
        const BodyState& now = state.units[u].body;
        const double along = now.velocity.dot(line_direction(event));
        other += kinetic_energy(body, now) - 0.5 * body.mass * along * along;
    }
    return other;
}

// Is the barrier one straight face, of elements that are joined? `rounded`: may its ends be?
bool is_straight(const Scene& scene, bool rounded) {
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i) {
        const Shape& shape = scene.obstacles[i].shape;
        const auto* post = std::get_if<Post>(&shape);
        const bool is_end = post != nullptr && post->opens;
        const bool straight = std::holds_alternative<HalfSpace>(shape) ||
                              std::holds_alternative<Prism>(shape) || (rounded && is_end);
        if (!straight || scene.obstacles[i].structure != 0) return false;
    }
    return true;
}

double speed_along(const State& state, const Event& event) {
    return std::abs(state.units.front().body.velocity.dot(line_direction(event)));
}

bool is_stopped(const Scene& scene, double speed) {
    return !(speed > tolerance::stopped_share * scene.approach.speed);
}

double time_left(const Scene& scene, const State& state) {
    return std::max(tolerance::longest_event, scene.duration.value_or(0.0)) - state.time;
}

// Will friction have stopped the vehicle when the longest run ends?
bool will_be_stopped(const Scene& scene, const State& state, const Event& event) {
    const double speed = speed_along(state, event);
    const double braking = (event.slides_from_speed - speed) / (state.time - event.slides_since);
    return is_stopped(scene, speed - std::max(0.0, braking) * time_left(scene, state));
}

// Will the vehicle still move on as it came, beside the barrier, when the longest run ends?
bool goes_on_sliding(const Scene& scene, const State& state, const Event& event) {
    const double along = state.units.front().body.velocity.dot(line_direction(event));
    if (!(along * scene.heading().dot(line_direction(event)) > 0.0)) return false;
    if (will_be_stopped(scene, state, event)) return false;
    double reach = 0.0;
    for (const Unit& unit : scene.vehicle->units)
        reach = std::max(reach, unit.trusses.reach);
    return distance_to_end(scene, state, event) > std::abs(along) * time_left(scene, state) + reach;
}

}  // namespace

void note_sliding(const Scene& scene, const State& state, Event& event) {
    if (event.decided()) return;
    if (!may_slide(scene, state) || !(other_energy(scene, state, event) < rest_energy(scene))) {
        event.slides_since = infinity;
    } else if (!(event.slides_since < state.time)) {
        event.slides_since = state.time;
        event.slides_from_speed = speed_along(state, event);
    }
}

bool slides_on(const Scene& scene, const State& state, const Event& event) {
    if (!(event.slides_since <= state.time) || !(distance_past_line(scene, state, event) < 0.0)) return false;
    if (is_stopped(scene, speed_along(state, event))) return false;
    const bool settled = state.time - event.slides_since >= tolerance::rest_duration;
    if (other_energy(scene, state, event) + state.energies.stored < rest_energy(scene)) {
        const bool brakes = scene.settings.braking > 0.0;
        return is_straight(scene, false) && (!brakes || (settled && !will_be_stopped(scene, state, event)));
    }
    return settled && event.touching && is_straight(scene, true) && goes_on_sliding(scene, state, event);
}

}  // namespace birm3d
