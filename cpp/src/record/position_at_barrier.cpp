#include "record/position_at_barrier.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

// Bounds of a shape, own axes (m). A post that has a top is cut off at its foot, because one that tilts has its endless lower
// end in the ground.
Box seen_box(const Shape& shape) {
    const auto* post = std::get_if<Post>(&shape);
    if (post == nullptr || !std::isfinite(post->height)) return bounds(shape);
    const double half = 0.5 * post->height;
    return {{0.0, 0.0, half}, {post->radius, post->radius, half}};
}

// The least and the greatest coordinate of an element along a direction of the world (m).
struct Range {
    double low, high;
};
Range range_along(const Scene& scene, std::size_t i, const State& state, const Vec3& direction) {
    const Pose pose = pose_of(scene, i, state);
    const Box box = seen_box(scene.obstacles[i].shape);
    const Vec3 local = pose.rotation.transpose() * direction;
    double middle = pose.position.dot(direction), half = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(local[axis]) < tolerance::along_line) continue;  // 0 times infinity would be NaN
        middle += local[axis] * box.center[axis];
        half += std::abs(local[axis]) * box.half[axis];
    }
    return {middle - half, middle + half};
}

// Height of the top of a shape, own axes (m). A post has no end in its bounds, but its height is its top.
double top_of(const Shape& shape) {
    if (const auto* post = std::get_if<Post>(&shape)) return post->height;
    const Box box = bounds(shape);
    return box.center.z() + box.half.z();
}

}  // namespace

double up_cosine(const BodyState& body) {
    const Quat& q = body.orientation;
    return 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y());
}

double least_up_cosine(const State& state) {
    double least = 1.0;
    for (const UnitState& unit : state.units)
        least = std::min(least, up_cosine(unit.body));
    return least;
}

bool runs_along_line(const Scene& scene) {
    return std::abs(std::sin(scene.approach.angle)) < tolerance::along_line;
}

double line_position(const Scene& scene, const State& state, const Vec3& towards) {
    const bool along = runs_along_line(scene);
    double first = infinity, last = -infinity;
    bool mesh = false;
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i) {
        const bool is_mesh = std::holds_alternative<TriangleMesh>(scene.obstacles[i].shape);
        if (!along && !is_mesh) continue;
        const Range range = range_along(scene, i, state, towards);
        first = std::min(first, range.low), last = std::max(last, range.high);
        mesh |= is_mesh;
    }
    if (along) return first;
    return mesh ? last : 0.0;
}

double distance_past_line(const Scene& scene, const State& state, const Event& event) {
    const Vec3& center = state.units.front().body.position;
    if (!scene.slides() || runs_along_line(scene)) return center.dot(event.towards) - event.line;
    // Beyond the chain's ends the line goes on as the undeformed one, however the last segment has turned.
    double nearest = infinity, past = 0.0;
    for (std::size_t i = 0; i < state.moving_elements.size(); ++i) {
        const Pose pose = pose_of(scene, i, state);
        const Vec3 local = pose.rotation.transpose() * (center - pose.position);
        const double half = scene.barrier->moving_elements[i].half_length;
        const Vec3 end = pose.position + pose.rotation * (std::clamp(local.y(), -half, half) * Vec3::UnitY());
        const double distance = std::hypot(local.x(), std::max(0.0, std::abs(local.y()) - half));
        if (distance >= nearest) continue;
        nearest = distance;
        past = std::abs(local.y()) > half ? (center - end).dot(event.towards) : local.x();
    }
    return past;
}

bool stands_over_barrier(const Scene& scene, const State& state) {
    const BodyState& body = state.units.front().body;
    const TrussMesh& mesh = scene.vehicle->units.front().trusses;
    // Around the rigid body and the mass centre, which lies before the frame of a tractor.
    const Vec3 low = (mesh.anchors.center - mesh.anchors.half).cwiseMin(0.0),
               high = (mesh.anchors.center + mesh.anchors.half).cwiseMax(0.0);
    std::vector<std::size_t> about;
    scene.map.find(body.position, mesh.reach, about);
    for (const std::size_t i : about) {
        if (i == scene.ground) continue;
        const Pose pose = pose_of(scene, i, state);
        const Box box = bounds(scene.obstacles[i].shape);
        const double top = top_of(scene.obstacles[i].shape);
        const bool is_post = std::holds_alternative<Post>(scene.obstacles[i].shape);
        const double up = is_post ? pose.rotation(2, 2) * top : top;
        if (!(pose.position.z() + up < body.position.z())) continue;
        // The place of the top that is nearest to the mass centre, seen from above.
        Vec3 place = pose.rotation.transpose() * (body.position - pose.position);
        for (int axis = 0; axis < 2; ++axis)
            place[axis] =
                std::clamp(place[axis], box.center[axis] - box.half[axis], box.center[axis] + box.half[axis]);
        place.z() = top;
        const Vec3 from = pose.position + pose.rotation * place - body.position;
        if (up_cosine(body) <
            tolerance::upright_cosine) {  // on its side: its outline from above is taken as a circle
            if (std::hypot(from.x(), from.y()) < mesh.anchors.half.minCoeff()) return true;
            continue;
        }
        const Vec3 local = body.orientation.conjugate() * from;
        if ((low.array() <= local.array()).head<2>().all() && (local.array() <= high.array()).head<2>().all())
            return true;
    }
    return false;
}

Vec3 line_direction(const Event& event) {
    return {-event.towards.y(), event.towards.x(), 0.0};
}

bool is_clear_of_barrier(const Scene& scene, const State& state, const Event& event) {
    const Vec3& center = state.units.front().body.position;
    const Vec3 line = line_direction(event);
    const double far = tolerance::clear_of_barrier * scene.vehicle->units.front().trusses.reach;
    const auto outside = [&](std::size_t i, const Vec3& direction) {
        const Range range = range_along(scene, i, state, direction);
        const double at = center.dot(direction);
        return std::max({0.0, range.low - at, at - range.high});
    };
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i)
        if (std::hypot(outside(i, line), outside(i, event.towards)) <= far) return false;
    return true;
}

bool crossed_beside_elements(const Scene& scene, const State& state, const Event& event) {
    if (!event.crossed) return false;
    const Vec3 line = line_direction(event);
    const double at = event.crossing.dot(line);
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i) {
        const Range along = range_along(scene, i, state, line);
        if (along.low <= at && at <= along.high) return false;
    }
    return true;
}

bool is_behind_element(const Scene& scene, const State& state, const Event& event) {
    if (!event.crossed) return false;
    const Vec3 line = line_direction(event);
    const double at = event.crossing.dot(line), place = state.units.front().body.position.dot(event.towards);
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i) {
        const Range along = range_along(scene, i, state, line);
        if (along.low <= at && at <= along.high && place > range_along(scene, i, state, event.towards).high)
            return true;
    }
    return false;
}

bool passes_between(const Scene& scene, const State& state, const Event& event) {
    const Vec3 line = line_direction(event);
    const double at = event.crossing.dot(line);
    bool low = false, high = false;  // is any element on that side?
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i) {
        const Range range = range_along(scene, i, state, line);
        (0.5 * (range.low + range.high) < at ? low : high) = true;
    }
    return low && high;
}

bool is_beyond_end(const Scene& scene, const State& state, const Event& event) {
    return distance_to_end(scene, state, event) < 0.0;
}

double distance_to_end(const Scene& scene, const State& state, const Event& event) {
    const BodyState& body = state.units.front().body;
    const Vec3 line = line_direction(event), direction = body.velocity.dot(line) < 0.0 ? Vec3(-line) : line;
    double end = -infinity;
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i)
        end = std::max(end, range_along(scene, i, state, direction).high);
    return end - body.position.dot(direction);
}

}  // namespace birm3d
