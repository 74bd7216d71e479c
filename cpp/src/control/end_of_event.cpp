#include "control/end_of_event.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "birm3d/base/tolerances.hpp"
#include "kernels/integrate.hpp"
#include "kernels/tires.hpp"
#include "scene/bodies.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

// Vector to `p` from the nearest point of a box.
Vec3 from_box(const Box& box, const Vec3& p) {
    const Vec3 from = p - box.center;
    return from - from.cwiseMax(-box.half).cwiseMin(box.half);
}

// Vector to `p` from the nearest point of a convex hull of the shape, own axes.
Vec3 from_hull(const Shape& shape, const Box& box, const Vec3& p) {
    if (const auto* plane = std::get_if<HalfSpace>(&shape))
        return std::max(0.0, plane->gap(p)) * plane->normal;
    return from_box(box, p);
}

// The box around two boxes.
Box around_both(const Box& one, const Box& other) {
    Box both = one;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = std::min(one.center[axis] - one.half[axis], other.center[axis] - other.half[axis]);
        const double high =
            std::max(one.center[axis] + one.half[axis], other.center[axis] + other.half[axis]);
        both.half[axis] = 0.5 * (high - low);
        if (std::isfinite(both.half[axis])) both.center[axis] = 0.5 * (low + high);
    }
    return both;
}

// Around all that is joined to obstacle `i`, in its own axes.
Box box_of_structure(const Scene& scene, std::size_t i) {
    const Obstacle& first = scene.obstacles[i];
    Box box = bounds(first.shape);
    for (std::size_t j = i + 1; j < scene.obstacles.size(); ++j) {
        const Obstacle& part = scene.obstacles[j];
        if (part.structure != i) continue;
        box = around_both(box, bounds(part.shape)
                                   .placed(first.rotation.transpose() * part.rotation,
                                           first.rotation.transpose() * (part.position - first.position)));
    }
    return box;
}

// Is the vehicle still lifting a wheel from the ground, tilting further, or tipped over and not yet at rest?
bool tips(const Scene& scene, const State& state) {
    if (!scene.settings.ground || scene.settings.gravity == 0.0) return false;
    constexpr double least_tilt = 0.01;  // sine; below it the direction of tilting is not clear
    std::vector<RigidContact> wheels;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const BodyState& body = state.units[u].body;
        const Unit& unit = scene.vehicle->units[u];
        if (unit.wheels.empty()) continue;
        const Vec3 up = body.orientation * Vec3::UnitZ();
        if (up.z() < tolerance::upright_cosine) return true;
        const Vec3 level_axis = Vec3::UnitZ().cross(up);  // a rotation about it tilts the vehicle further
        if (angular_velocity(unit.body, body).dot(level_axis) >
            tolerance::tilting_rate * std::max(least_tilt, level_axis.norm()))
            return true;
        wheels.clear();
        find_tire_contacts(unit, u, body, state.units[u].given_way, WheelAt::droop, wheels);
        const Twist motion = twist(unit.body, body);
        for (const RigidContact& wheel : wheels)
            if (wheel.gap > tolerance::lifted_wheel &&
                (motion.velocity + motion.angular_velocity.cross(wheel.arm)).z() > 0.0)
                return true;
    }
    return false;
}

// Does a unit that stands on its wheels slide sideways, or turn? Its tyres then still change the direction of its path.
bool skids(const Scene& scene, const State& state) {
    constexpr double slowest = 0.5,
                     share = 0.1;  // m/s; of the speed: a slide that turns the path by 6 degrees
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const Unit& unit = scene.vehicle->units[u];
        const BodyState& body = state.units[u].body;
        if (unit.wheels.empty() || !((body.orientation * Vec3::UnitZ()).z() > tolerance::upright_cosine))
            continue;
        const double yaw_rate = angular_velocity(unit.body, body).z(),
                     least = std::max(slowest, share * body.velocity.norm());
        if (std::abs(body.velocity.dot(body.orientation * Vec3::UnitY())) > least ||
            std::abs(yaw_rate) * unit.trusses.reach > least)
            return true;
    }
    return false;
}

// Boxes around the barrier, around each of its posts or around its free-standing chain. Axes: towards the barrier, along its
// line, upwards.
std::vector<Box> boxes_of_barrier(const Scene& scene, const State& state, const Mat3& axes) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i) {
        if (scene.obstacles[i].structure != i) continue;
        const Pose pose = pose_of(scene, i, state);
        const Box box = box_of_structure(scene, i).placed(axes.transpose() * pose.rotation,
                                                          axes.transpose() * pose.position);
        if (boxes.empty() || !scene.slides())
            boxes.push_back(box);
        else
            boxes.front() = around_both(boxes.front(), box);
    }
    return boxes;
}

// May a vehicle that moves away from all elements still come past an end of the barrier? It may where it skids beside an end, or
// rolls on beside it, and is not past the barrier yet. If it was turned back, it must be near.
bool may_pass_an_end(const Scene& scene, const State& state, const KnownPath& path) {
    if (!scene.settings.ground || scene.settings.gravity == 0.0 || scene.settings.mu_tire == 0.0)
        return false;
    const Vec3& motion = state.units.front().body.velocity;
    const bool rolls_in = motion.dot(scene.towards()) > tolerance::coasting_speed;
    const bool moves = motion.norm() > tolerance::coasting_speed;  // its tyres may still turn its path
    if (!rolls_in && !skids(scene, state) && (path.turned_back || path.is_past || !moves)) return false;
    Mat3 axes;
    axes << scene.towards(), Vec3::UnitZ().cross(scene.towards()), Vec3::UnitZ();
    const Vec3 place = axes.transpose() * state.units.front().body.position,
               velocity = axes.transpose() * state.units.front().body.velocity;
    const double margin = tolerance::clear_of_barrier * scene.vehicle->units.front().trusses.reach;
    bool past = velocity.x() > 0.0, clear = true;
    for (const Box& box : boxes_of_barrier(scene, state, axes)) {
        if (std::abs(place.y() - box.center.y()) < box.half.y() - margin) return false;
        past = past && place.x() > box.center.x();
        clear = clear && from_box(box, place).head<2>().norm() > margin;
    }
    return !past && !(path.turned_back && clear);
}

// Moving elements that friction can stop have stopped.
bool moving_elements_rest(const Scene& scene, const State& state) {
    const bool slides_on = scene.slides() && (scene.settings.gravity == 0.0 ||
                                              scene.barrier->free_standing->ground_friction == 0.0);
    if (state.moving_elements.empty() || slides_on) return true;
    return fastest_moving_element(scene, state) == 0.0;
}

BodyState between(const BodyState& a, const BodyState& b, double fraction) {
    BodyState body;
    body.position = a.position + fraction * (b.position - a.position);
    body.orientation = a.orientation.slerp(fraction, b.orientation);
    body.velocity = a.velocity + fraction * (b.velocity - a.velocity);
    body.angular_momentum = a.angular_momentum + fraction * (b.angular_momentum - a.angular_momentum);
    return body;
}

// How a unit's mass centre lies to an element or a chain.
struct Departure {
    double distance;  // m
    double away;      // m/s
};

// Where the unit moves forward it must be out of reach; else it suffices that it moves away faster than any rotation can bring
// a point of it back.
bool departs(const Scene& scene, const Unit& unit, const BodyState& body, const Departure& departure) {
    const bool forward = body.velocity.dot(scene.towards()) > 0.0;
    const double rotation_speed = angular_velocity(unit.body, body).norm() * unit.trusses.reach;
    const bool outruns = !forward && departure.away >= rotation_speed;
    return departure.away > 0.0 && (outruns || departure.distance > unit.trusses.reach);
}

// Away from every element, or from the box of all that is joined to it.
bool has_left_elements(const Scene& scene, const State& state, std::size_t u) {
    const Unit& unit = scene.vehicle->units[u];
    const BodyState& body = state.units[u].body;
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i) {
        const Obstacle& element = scene.obstacles[i];
        if (element.structure != i) continue;
        const Pose pose = pose_of(scene, i, state);
        const Placement in_shape = placement(pose, body);
        const Vec3 from = from_hull(element.shape, box_of_structure(scene, i), in_shape.position);
        const double distance = from.norm();
        if (!(distance > 0.0)) return false;
        const Vec3 direction = from / distance;
        double away = (pose.rotation.transpose() * body.velocity).dot(from) / distance;
        if (i < state.moving_elements.size()) {
            const Vec3 own_velocity = pose.rotation.transpose() * state.moving_elements[i].velocity;
            away -= std::max(0.0, own_velocity.dot(direction)) +
                    fastest_point(scene.barrier->moving_elements[i], state.moving_elements[i]) -
                    own_velocity.norm();
        }
        if (!departs(scene, unit, body, {distance, away})) return false;
    }
    return true;
}

// Away from the box around a free-standing chain as it lies now. A vehicle that was redirected still nears its far segments.
bool has_left_chain(const Scene& scene, const State& state, std::size_t u) {
    if (!scene.slides()) return false;
    const Mat3& axes = scene.obstacles.front().rotation;
    std::optional<Box> chain;
    for (std::size_t i = 0; i < state.moving_elements.size(); ++i) {
        const Pose pose = pose_of(scene, i, state);
        const Box segment = bounds(scene.obstacles[i].shape)
                                .placed(axes.transpose() * pose.rotation, axes.transpose() * pose.position);
        chain = chain ? around_both(*chain, segment) : segment;
    }
    const BodyState& body = state.units[u].body;
    const Vec3 position = axes.transpose() * body.position;
    const Vec3 from = from_box(*chain, position);
    const double distance = from.norm();
    if (!(distance > 0.0)) return false;
    const double away = (axes.transpose() * body.velocity).dot(from) / distance;
    return departs(scene, scene.vehicle->units[u], body,
                   {distance, away - fastest_moving_element(scene, state)});
}

}  // namespace

bool touches(const State& state) {
    return std::any_of(state.units.begin(), state.units.end(),
                       [](const UnitState& unit) { return unit.skin.normal_force > 0.0; });
}

bool has_left(const Scene& scene, const State& state) {
    for (std::size_t u = 0; u < state.units.size(); ++u)
        if (!has_left_chain(scene, state, u) && !has_left_elements(scene, state, u)) return false;
    return true;
}

bool is_over(const Scene& scene, const State& state, const KnownPath& path) {
    return has_left(scene, state) && !tips(scene, state) && !may_pass_an_end(scene, state, path) &&
           moving_elements_rest(scene, state);
}

double time_of_decision(const Scene& scene, std::span<const BodyState> before, double released, double dt,
                        const KnownPath& path, State& now) {
    if (!is_over(scene, now, path)) return now.time;  // all came to rest
    std::vector<BodyState> after;
    list_body_states(now, after);
    const auto is_over_at = [&](double fraction) {
        for (std::size_t b = 0; b < after.size(); ++b)
            body_state(now, b) = between(before[b], after[b], fraction);
        return is_over(scene, now, path);
    };
    double open = released / dt, over = 1.0;
    if (is_over_at(open)) over = open;
    while ((over - open) * dt > tolerance::decision_resolution) {
        const double fraction = 0.5 * (open + over);
        (is_over_at(fraction) ? over : open) = fraction;
    }
    for (std::size_t b = 0; b < after.size(); ++b)
        body_state(now, b) = after[b];
    return now.time - (1.0 - over) * dt;
}

}  // namespace birm3d
