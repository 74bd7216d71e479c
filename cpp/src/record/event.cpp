#include "birm3d/record/event.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "birm3d/base/tolerances.hpp"
#include "control/end_of_event.hpp"
#include "kernels/integrate.hpp"
#include "record/rest.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A vehicle that moves at a smaller angle to the line neither leaves nor passes it: sine of one degree.
constexpr double parallel = 0.017452406;
constexpr double still_along = 0.1;  // the same in contact when the longest run ends: tangent of 6 degrees
constexpr double slow = 0.1;         // of the approach speed: below it a vehicle is stopped, not redirected
// Cosine of the up axis to the vertical beyond which a vehicle does not stand upright at the start: about 45 degrees.
constexpr double upright = 0.7;

bool touches_barrier(const Scene& scene, const State& state) {
    for (const UnitState& unit : state.units)
        for (const ContactLoad& load : unit.contact_loads)
            if (load.obstacle != scene.ground && load.normal_force > 0.0) return true;
    return false;
}

// Cosine between the up axis and the vertical.
double up(const BodyState& body) {
    const Quat& q = body.orientation;
    return 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y());
}

double least_up(const State& state) {
    double least = 1.0;
    for (const UnitState& unit : state.units)
        least = std::min(least, up(unit.body));
    return least;
}

// Of an element, along a direction of the world (m).
struct Range {
    double low, high;
};
Range range_along(const Scene& scene, std::size_t i, const State& state, const Vec3& direction) {
    const Pose pose = pose_of(scene, i, state);
    const Box box = bounds(scene.obstacles[i].shape);
    const Vec3 local = pose.rotation.transpose() * direction;
    double middle = pose.position.dot(direction), half = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(local[axis]) < tolerance::along_line) continue;  // 0 times infinity would be NaN
        middle += local[axis] * box.center[axis];
        half += std::abs(local[axis]) * box.half[axis];
    }
    return {middle - half, middle + half};
}

std::size_t element_count(const Scene& scene) {
    return scene.barrier->elements.size();
}

bool runs_along_line(const Scene& scene) {
    return std::abs(std::sin(scene.approach.angle)) < tolerance::along_line;
}

// Position of the barrier's line along `towards`: at the base. For a path along the line it is where the barrier
// begins, for meshes where they end.
double line_of(const Scene& scene, const State& state, const Vec3& towards) {
    const bool along = runs_along_line(scene);
    double first = infinity, last = -infinity;
    bool mesh = false;
    for (std::size_t i = 0; i < element_count(scene); ++i) {
        const bool is_mesh = std::holds_alternative<TriangleMesh>(scene.obstacles[i].shape);
        if (!along && !is_mesh) continue;
        const Range range = range_along(scene, i, state, towards);
        first = std::min(first, range.low), last = std::max(last, range.high);
        mesh |= is_mesh;
    }
    if (along) return first;
    return mesh ? last : 0.0;
}

// How far the leading mass centre is past the line (m); of free-standing segments past the nearest of them.
double distance_past(const Scene& scene, const State& state, const Event& event) {
    const Vec3& center = state.units.front().body.position;
    if (state.segments.empty() || runs_along_line(scene)) return center.dot(event.towards) - event.line;
    double nearest = infinity, past = 0.0;
    for (std::size_t i = 0; i < state.segments.size(); ++i) {
        const Pose pose = pose_of(scene, i, state);
        const Vec3 local = pose.rotation.transpose() * (center - pose.position);
        const double beyond = std::max(0.0, std::abs(local.y()) - scene.barrier->segments[i].half_length);
        const double distance = std::hypot(local.x(), beyond);
        if (distance < nearest) nearest = distance, past = local.x();
    }
    return past;
}

// Own axes (m). The bounds of a post are endless.
double top_of(const Shape& shape) {
    if (const auto* post = std::get_if<Post>(&shape)) return post->height;
    const Box box = bounds(shape);
    return box.center.z() + box.half.z();
}

// Does the top of any element stand under the rigid body of the leading unit?
bool stands_over(const Scene& scene, const State& state) {
    const BodyState& body = state.units.front().body;
    const TrussMesh& mesh = scene.vehicle->units.front().trusses;
    std::vector<std::size_t> about;
    scene.map.find(body.position, mesh.reach, about);
    for (const std::size_t i : about) {
        if (i == scene.ground) continue;
        const Pose pose = pose_of(scene, i, state);
        const Box box = bounds(scene.obstacles[i].shape);
        const double top = top_of(scene.obstacles[i].shape);
        if (!(pose.position.z() + top < body.position.z())) continue;
        // The place of the top that is nearest to the mass centre, seen from above.
        Vec3 place = pose.rotation.transpose() * (body.position - pose.position);
        for (int axis = 0; axis < 2; ++axis)
            place[axis] =
                std::clamp(place[axis], box.center[axis] - box.half[axis], box.center[axis] + box.half[axis]);
        place.z() = top;
        const Vec3 from = pose.position + pose.rotation * place - body.position;
        if (up(body) < upright) {  // on its side: its outline from above is taken as a circle
            if (std::hypot(from.x(), from.y()) < mesh.anchors.half.minCoeff()) return true;
            continue;
        }
        const Vec3 local = body.orientation.conjugate() * from - mesh.anchors.center;
        if (std::abs(local.x()) < mesh.anchors.half.x() && std::abs(local.y()) < mesh.anchors.half.y())
            return true;
    }
    return false;
}

// Along the barrier's line, level.
Vec3 line_direction(const Event& event) {
    return {-event.towards.y(), event.towards.x(), 0.0};
}

// Did it pass between two elements? Else beside the barrier's end.
bool passes_between(const Scene& scene, const State& state, const Event& event) {
    const Vec3 line = line_direction(event);
    const double at = event.crossing.dot(line);
    bool low = false, high = false;
    for (std::size_t i = 0; i < element_count(scene); ++i) {
        const Range range = range_along(scene, i, state, line);
        (0.5 * (range.low + range.high) < at ? low : high) = true;
    }
    return low && high;
}

// Is it beyond the barrier's end in the direction in which it goes?
bool is_beyond_end(const Scene& scene, const State& state, const Event& event) {
    const BodyState& body = state.units.front().body;
    const Vec3 line = line_direction(event), direction = body.velocity.dot(line) < 0.0 ? Vec3(-line) : line;
    for (std::size_t i = 0; i < element_count(scene); ++i)
        if (!(range_along(scene, i, state, direction).high < body.position.dot(direction))) return false;
    return true;
}

// Of a vehicle that has left for good.
void judge_departure(const Scene& scene, const State& state, Event& event) {
    const BodyState& body = state.units.front().body;
    const double past = distance_past(scene, state, event);
    const double speed = std::hypot(body.velocity.x(), body.velocity.y());
    const double into = body.velocity.dot(event.towards);
    if (past > 0.0 || into > parallel * speed) {
        if (event.over_top) {
            event.verdict = Verdict::overridden, event.manner = Manner::over;
            return;
        }
        if (!event.crossed) event.crossing = body.position - past / into * body.velocity;
        event.verdict = Verdict::passed;
        event.manner = passes_between(scene, state, event) ? Manner::between : Manner::beside;
        return;
    }
    const double along = body.velocity.dot(line_direction(event));
    // Component of the approach in that direction. A path square to the line has none: what moves back was stopped.
    const double came = scene.heading().dot(line_direction(event));
    const bool goes_on = std::abs(came) < parallel ? into > -parallel * speed : along * came > 0.0;
    if (goes_on && std::abs(along) > -into && speed > slow * scene.approach.speed) {
        event.verdict = Verdict::redirected;
        event.manner = is_beyond_end(scene, state, event) ? Manner::slides_to_end : Manner::leaves;
        return;
    }
    event.verdict = Verdict::stopped;
    event.manner = Manner::rebounds;
}

// Of a vehicle that has come to rest before it had left.
void judge_rest(const Scene& scene, const State& state, Event& event) {
    const double past = distance_past(scene, state, event);
    if (past > 0.0 && event.over_top) {
        event.verdict = Verdict::overridden, event.manner = Manner::over;
    } else if (past > 0.0 && !event.touching) {
        event.verdict = Verdict::passed, event.manner = Manner::rests_beyond;
    } else {
        event.verdict = Verdict::stopped;
        event.manner = state.touched ? Manner::rests : Manner::rests_untouched;
    }
}

// Does the vehicle slide along a straight barrier in a state that can not change: no motion across, no rotation, no
// contact load?
bool slides_on(const Scene& scene, const State& state, const Event& event) {
    if (!state.touched || !state.segments.empty() || runs_along_line(scene)) return false;
    const double least = rest_energy(scene);
    double across = state.energies.stored;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const RigidBody& body = scene.vehicle->units[u].body;
        const BodyState& now = state.units[u].body;
        const double along = now.velocity.dot(line_direction(event));
        across += kinetic_energy(body, now) - 0.5 * body.mass * along * along;
        if (!(across < least)) return false;
    }
    for (std::size_t i = 0; i < element_count(scene); ++i) {
        const Shape& shape = scene.obstacles[i].shape;
        const bool straight =
            std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<Prism>(shape);
        if (!straight || scene.obstacles[i].structure != 0) return false;
    }
    return distance_past(scene, state, event) < 0.0;
}

}  // namespace

Verdict Event::outcome() const {
    const bool not_past = verdict != Verdict::passed && verdict != Verdict::overridden;
    return not_past && rolled_over() ? Verdict::rolled_over : verdict;
}

Event begin_event(const Scene& scene, const State& start) {
    Event event;
    event.upright = least_up(start) > upright;
    event.least_upright = least_up(start);
    if (!scene.barrier) return event;
    event.manner = Manner::moving;
    event.towards = scene.towards();
    event.line = line_of(scene, start, event.towards);
    return event;
}

void follow_event(const Scene& scene, const State& state, const StepContact& contact, Event& event) {
    event.least_upright = std::min(event.least_upright, least_up(state));
    if (!scene.barrier) return;
    note_slowness(scene, state, event);
    const BodyState& body = state.units.front().body;
    if (!event.over_top && body.position.dot(event.towards) > event.line) {
        if (!event.crossed) event.crossed = true, event.crossing = body.position;
        event.over_top = stands_over(scene, state);
    }
    const bool touched_before = event.touching;
    event.touching = contact.held_by_barrier || touches_barrier(scene, state);
    if (event.touching) {
        if (!touched_before && event.left) ++event.later_contacts;
        return;
    }
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
    if (event.left && !event.touching && is_over(scene, state)) return true;
    if (rests(scene, state, event)) {
        if (!event.decided()) judge_rest(scene, state, event);
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

void judge_at_longest(const Scene& scene, const State& state, Event& event) {
    if (event.decided() || !state.touched || runs_along_line(scene)) return;
    const Vec3& velocity = state.units.front().body.velocity;
    const double along = velocity.dot(line_direction(event)), across = velocity.dot(event.towards);
    const bool goes_on = along * scene.heading().dot(line_direction(event)) > 0.0;
    if (!(velocity.norm() > slow * scene.approach.speed)) return judge_rest(scene, state, event);
    if (!goes_on || std::abs(across) > still_along * std::abs(along)) return;
    if (distance_past(scene, state, event) < 0.0)
        event.verdict = Verdict::redirected, event.manner = Manner::slides_on;
}

}  // namespace birm3d
