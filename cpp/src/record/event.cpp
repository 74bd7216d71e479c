#include "birm3d/record/event.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "control/end_of_event.hpp"
#include "record/position_at_barrier.hpp"
#include "record/rest.hpp"
#include "record/sliding.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

// A vehicle that moves at a smaller angle to the line neither leaves nor passes it: sine of one degree.
constexpr double parallel = 0.017452406;

bool touches_barrier(const Scene& scene, const State& state) {
    return std::any_of(state.units.begin(), state.units.end(),
                       [&](const UnitState& unit) { return skin_touches_barrier(scene, unit); });
}

// Gives the event of a vehicle that left on the side it came from its verdict: stopped or redirected, by its motion as it lost
// contact, to which its exit speed and angle belong.
void judge_return(const Scene& scene, const State& state, Event& event) {
    const Vec3& exit = state.touched ? event.released_velocity : state.units.front().body.velocity;
    const double along = exit.dot(line_direction(event)), back = -exit.dot(event.towards),
                 exit_speed = std::hypot(exit.x(), exit.y());
    // Component of the approach in that direction. A path square to the line has none: what moves back was stopped.
    const double came = scene.heading().dot(line_direction(event));
    const bool goes_on = std::abs(came) < parallel ? back < parallel * exit_speed : along * came > 0.0;
    if (goes_on && std::abs(along) > back && exit_speed > tolerance::stopped_share * scene.approach.speed) {
        event.verdict = Verdict::redirected;
        event.manner = is_beyond_end(scene, state, event) ? Manner::slides_to_end : Manner::leaves;
        return;
    }
    event.verdict = Verdict::stopped;
    event.manner = state.touched ? Manner::rebounds : Manner::rests_untouched;
}

// Gives the event of a vehicle that has left for good its verdict.
void judge_departure(const Scene& scene, const State& state, Event& event) {
    const BodyState& body = state.units.front().body;
    const double past = distance_past_line(scene, state, event);
    const double speed = std::hypot(body.velocity.x(), body.velocity.y());
    const double into = body.velocity.dot(event.towards);
    // What the barrier has turned back does not pass it, though its tyres may turn its path once more.
    if (past > 0.0 || (into > parallel * speed && !event.turned_back())) {
        if (event.over_top) {
            event.verdict = Verdict::overridden, event.manner = Manner::over;
            return;
        }
        if (!event.crossed) event.crossing = body.position - past / into * body.velocity;
        event.verdict = Verdict::passed;
        event.manner = passes_between(scene, state, event) ? Manner::between : Manner::beside;
        return;
    }
    judge_return(scene, state, event);
}

// Has a vehicle that seemed to pass as it left turned away before the line? The tyres of a yawed vehicle turn its path.
bool has_turned_away(const Scene& scene, const State& state, bool at_end, const Event& event) {
    if (event.verdict != Verdict::passed || event.crossed || distance_past_line(scene, state, event) > 0.0)
        return false;
    const Vec3& velocity = state.units.front().body.velocity;
    return -velocity.dot(event.towards) > std::max(tolerance::coasting_speed, parallel * velocity.norm()) &&
           (at_end || is_clear_of_barrier(scene, state, event));
}

// A vehicle that was stopped or redirected has passed if it comes past an end of the barrier afterwards, on a curved path. One
// that seemed to pass, and turned away before the line, has not passed. One that was turned back is judged until it is clear.
// `at_end`: is the run over? Then what moves towards the line has passed.
void revise(const Scene& scene, const State& state, bool at_end, Event& event) {
    if (!event.left || event.clear || event.touching || event.rolled_over() || runs_along_line(scene)) return;
    if (has_turned_away(scene, state, at_end, event)) {
        judge_return(scene, state, event);
        event.clear = true;
        return;
    }
    if (event.verdict != Verdict::stopped && event.verdict != Verdict::redirected) return;
    const Vec3& velocity = state.units.front().body.velocity;
    event.clear = event.turned_back() && is_clear_of_barrier(scene, state, event);
    const bool moves = velocity.norm() > tolerance::coasting_speed;
    const bool nears =
        at_end && !event.clear &&
        velocity.dot(event.towards) > std::max(tolerance::coasting_speed, parallel * velocity.norm());
    const bool past =
        distance_past_line(scene, state, event) > 0.0 && crossed_beside_elements(scene, state, event);
    if (!nears && !past) return;
    event.verdict = Verdict::passed;
    event.manner = moves ? Manner::beside : Manner::rests_beyond;
}

// Gives the event of a vehicle that came to rest before it had left its verdict.
void judge_rest(const Scene& scene, const State& state, Event& event) {
    const double past = distance_past_line(scene, state, event);
    if (past > 0.0 && (event.over_top || is_behind_element(scene, state, event))) {
        event.verdict = Verdict::overridden, event.manner = Manner::over;
    } else if (past > 0.0 && !event.touching) {
        event.verdict = Verdict::passed, event.manner = Manner::rests_beyond;
    } else {
        event.verdict = Verdict::stopped;
        event.manner = state.touched ? Manner::rests : Manner::rests_untouched;
    }
}

}  // namespace

Verdict Event::outcome() const {
    if (!rolled_over() || is_past()) return verdict;
    return behind_element ? Verdict::overridden : Verdict::rolled_over;
}

Event begin_event(const Scene& scene, const State& start) {
    Event event;
    event.upright = least_up_cosine(start) > tolerance::upright_cosine;
    event.least_upright = least_up_cosine(start);
    if (!scene.barrier) return event;
    event.manner = Manner::moving;
    event.towards = scene.towards();
    event.line = line_position(scene, start, event.towards);
    return event;
}

void follow_event(const Scene& scene, const State& state, const StepContact& contact, Event& event) {
    event.least_upright = std::min(event.least_upright, least_up_cosine(state));
    if (!scene.barrier) return;
    note_creeping(scene, state, event);
    note_sliding(scene, state, event);
    const BodyState& body = state.units.front().body;
    if (!event.over_top && body.position.dot(event.towards) > event.line) {
        if (!event.crossed) event.crossed = true, event.crossing = body.position;
        event.over_top = stands_over_barrier(scene, state);
    }
    if (event.crossed && event.rolled_over()) event.behind_element = is_behind_element(scene, state, event);
    const bool touched_before = event.touching;
    event.touching = contact.held_by_barrier || touches_barrier(scene, state);
    if (event.touching) {
        if (!touched_before && event.left) ++event.later_contacts;
        return;
    }
    revise(scene, state, false, event);
    if (event.left || event.decided()) return;
    if (touched_before) {
        event.released_at = std::min(contact.begin + contact.released, state.time);
        event.released_velocity = body.velocity;
    }
    if (!has_left(scene, state)) return;
    event.left = true;
    event.separated = state.touched;
    event.deflection = greatest_deflections(*scene.vehicle, state).left;
    if (!event.decided()) judge_departure(scene, state, event);
}

bool is_decided(const Scene& scene, const State& state, Event& event) {
    // One that is to pass is followed up to the line: its tyres may turn it away.
    const KnownPath path{event.turned_back() || event.clear,
                         event.is_past() && (event.crossed || event.over_top)};
    const bool over = event.left && !event.touching && is_over(scene, state, path),
               at_rest = rests(scene, state, event);
    if (over || at_rest) {
        if (!over && !event.decided()) judge_rest(scene, state, event);
        revise(scene, state, true, event);
        return true;
    }
    if (event.decided() || !slides_on(scene, state, event)) return false;
    event.verdict = Verdict::redirected, event.manner = Manner::slides_on;
    if (!event.touching) {
        event.left = event.separated = true;
        event.deflection = greatest_deflections(*scene.vehicle, state).left;
    }
    return true;
}

bool rolls_on(const State& state, const Event& event) {
    // One that has rolled on, and now touches the barrier, is followed through that contact.
    const bool followed = state.time > tolerance::longest_event + tolerance::shortest_step;
    return !event.decided() && (followed || !event.touching) &&
           state.units.front().body.velocity.norm() > tolerance::coasting_speed;
}

void judge_at_longest(const Scene& scene, const State& state, Event& event) {
    revise(scene, state, true, event);
    if (event.decided() || !scene.barrier || runs_along_line(scene)) return;
    if (!state.touched) {
        if (!rolls_on(state, event)) judge_rest(scene, state, event);
        return;
    }
    if (is_behind_element(scene, state, event)) {
        event.verdict = Verdict::overridden, event.manner = Manner::over;
        return;
    }
    const Vec3& velocity = state.units.front().body.velocity;
    const double along = velocity.dot(line_direction(event)), across = velocity.dot(event.towards);
    const bool goes_on = along * scene.heading().dot(line_direction(event)) > 0.0;
    if (!(velocity.norm() > tolerance::stopped_share * scene.approach.speed)) {
        judge_rest(scene, state, event);
        if (event.manner == Manner::rests && velocity.norm() > tolerance::coasting_speed)
            event.manner = Manner::slow;
        return;
    }
    if (!goes_on || std::abs(across) > tolerance::nearly_along * std::abs(along)) return;
    if (distance_past_line(scene, state, event) < 0.0)
        event.verdict = Verdict::redirected, event.manner = Manner::slides_on;
}

}  // namespace birm3d
