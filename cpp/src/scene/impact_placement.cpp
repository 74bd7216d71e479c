// The path of the vehicle in a scene and its position at the start.
#include "birm3d/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "birm3d/base/error.hpp"
#include "birm3d/base/rotation.hpp"
#include "birm3d/base/tolerances.hpp"
#include "kernels/integrate.hpp"
#include "kernels/suspension.hpp"
#include "kernels/tires.hpp"
#include "scene/indentation_gaps.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

// How far the barrier reaches along `direction` (m).
double extent(const std::vector<Obstacle>& elements, const Vec3& direction) {
    double most = -infinity;
    for (const Obstacle& element : elements) {
        const Vec3 local = element.rotation.transpose() * direction;
        if (const auto* plane = std::get_if<HalfSpace>(&element.shape)) {
            const bool ends = (local - plane->normal).norm() < 1e-12;
            most = std::max(most, ends ? element.position.dot(direction) + plane->offset : infinity);
            continue;
        }
        const Box box = bounds(element.shape);
        double reach = element.position.dot(direction);
        for (int i = 0; i < 3; ++i)
            if (std::abs(local[i]) > 1e-12)
                reach += local[i] * box.center[i] + std::abs(local[i]) * box.half[i];
        most = std::max(most, reach);
    }
    return most;
}

void move(State& state, const Vec3& distance) {
    for (UnitState& unit : state.units)
        unit.body.position += distance;
}

// A rolled vehicle stands on its lowest point.
void raise_to_ground(const Scene& scene, State& state) {
    double lowest = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const Unit& unit = scene.vehicle->units[u];
        std::vector<RigidContact> wheels;
        find_tire_contacts(unit, u, state.units[u].body, state.units[u].given_way, WheelAt::rest, wheels);
        for (const RigidContact& wheel : wheels)
            lowest = std::min(lowest, wheel.gap);
        if (scene.skin_meets_ground[u])
            for (std::size_t i = 0; i < unit.trusses.skin; ++i)
                lowest = std::min(lowest, (state.units[u].body.position +
                                           state.units[u].body.orientation * unit.trusses.node(i))
                                              .z());
    }
    move(state, -lowest * Vec3::UnitZ());
}

// Greatest depth of an indentation at the start (m). A deeper post has passed the panel's edge and is ignored.
constexpr double deepest_start = 0.3;

// Moves the vehicle back to before any post or top edge indents it.
void stand_back(const Scene& scene, const Vec3& heading, State& state) {
    constexpr int most_steps = 50;
    for (int i = 0; i < most_steps; ++i) {
        const double overlap = overlap_of_indentations(scene, state, deepest_start);
        if (overlap == 0.0) return;
        move(state, -(overlap + tolerance::touching_gap) * heading);
    }
}

struct Ends {
    double rear, front;
};

// Of the uncrushed vehicle along a direction (m).
Ends ends_along(const Scene& scene, const State& state, const Vec3& direction) {
    Ends ends{infinity, -infinity};
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const BodyState& body = state.units[u].body;
        const TrussMesh& mesh = scene.vehicle->units[u].trusses;
        const Mat3 R = body.orientation.toRotationMatrix();
        const Vec3 local = R.transpose() * direction;
        const double middle = direction.dot(body.position);
        const auto compare = [&](std::size_t b, const Box& box, const BlockColumn& x, const BlockColumn& y,
                                 const BlockColumn& z) {
            // A block that can not reach further is left out.
            const double center = middle + local.dot(box.center);
            const double reach = local.cwiseAbs().dot(box.half) + 1e-9 * (1.0 + std::abs(center));
            if (center + reach < ends.front && center - reach > ends.rear) return;
            for (std::size_t i = 0; i < mesh.nodes_in(b); ++i) {
                const double at = direction.dot(body.position + R * Vec3(x[i], y[i], z[i]));
                ends.front = std::max(ends.front, at), ends.rear = std::min(ends.rear, at);
            }
        };
        for (std::size_t b = 0; b < mesh.blocks; ++b) {
            const TrussBlock& trusses = mesh.block[b];
            compare(b, mesh.node_box[b], trusses.node_x, trusses.node_y, trusses.node_z);
            if (b < mesh.skin_blocks)
                compare(b, mesh.anchor_box[b], trusses.anchor_x, trusses.anchor_y, trusses.anchor_z);
        }
    }
    return ends;
}

// Moves the vehicle of `state` along its path, forward or back, until its nearest point stands `standoff` before the
// barrier. A path past the barrier starts where the barrier begins.
void place(const Scene& scene, const Vec3& heading, State& state) {
    const Barrier& barrier = *scene.barrier;
    const std::vector<Obstacle> elements(
        scene.obstacles.begin(),
        scene.obstacles.begin() + static_cast<std::ptrdiff_t>(barrier.elements.size()));
    // Towards the barrier, or along it for a path that never comes nearer.
    const Vec3 inward = heading.dot(barrier.normal()) < -1e-12 ? Vec3(-barrier.normal()) : heading;
    const double first = -extent(elements, -inward), last = extent(elements, inward);
    if (!std::isfinite(first))
        refuse("impact_angle", "> 0 and < 180 deg where the barrier has no end",
               scene.approach.angle * 180.0 / std::numbers::pi);
    const auto [rear, front] = ends_along(scene, state, inward);
    const double pace = heading.dot(inward);
    const double to_plane = (first - scene.approach.standoff - front) / pace;
    move(state, to_plane * heading);
    const bool plane_only = elements.size() == 1 && std::holds_alternative<HalfSpace>(elements[0].shape);
    if (plane_only) return;

    // From there it moves by the distance that is certainly free, step by step.
    const double longest = (last - first + front - rear) / pace + scene.approach.standoff;
    double distance = 0.0;
    constexpr int most_steps = 1000;
    for (int i = 0; i < most_steps && distance <= longest; ++i) {
        const double free = nearest_gap(scene, state, {.anchors = true}) - scene.approach.standoff;
        move(state, free * heading);
        distance += free;
        if (std::abs(free) < tolerance::initial_overlap * 1e-3) break;
        // Else a thin post would slip between two columns of nodes.
        if (overlap_of_indentations(scene, state, deepest_start) > 0.0) break;
    }
    if (distance <= longest) {
        stand_back(scene, heading, state);
        return;
    }
    move(state, -distance * heading);
}

// At barrier heading 0 the line runs along +y: the path (sin, cos) meets it at the impact angle.
double yaw_of_path(const Scene& scene) {
    const double barrier_heading = scene.barrier ? scene.barrier->heading : 0.0;
    return barrier_heading + 0.5 * std::numbers::pi - scene.approach.angle;
}

// Difference of two decimal numbers without rounding errors: 1000.3 - 1000 is 0.3. Of all values within a few
// roundings of numbers as large as `size`, it is the one with the fewest decimals.
double difference_as_written(double a, double b, double size) {
    const double difference = a - b;
    if (size == 0.0) return difference;
    const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * (std::abs(a) + size);
    for (double scale = 1.0; scale < 1e16; scale *= 10.0) {
        const double rounded = std::round(difference * scale) / scale;
        if (std::abs(rounded - difference) <= rounding) return rounded;
    }
    return difference;
}

Vec3 direction_of_line(const Scene& scene) {
    const double heading = scene.barrier ? scene.barrier->heading : 0.0;
    return {-std::sin(heading), std::cos(heading), 0.0};
}

// Is the path so nearly along the line that the place where they meet would have no digits left?
bool never_meets_line(const Scene& scene) {
    return std::abs(std::sin(scene.approach.angle)) <= 1e-12;
}

// Where the path of the mass centre meets the line, from the barrier's origin. Zero of the line is its point nearest to
// the world's origin, wherever along it the elements stand. A path along the line never meets it: the offset is its
// distance, away from the traffic.
Vec3 foot_of_path(const Scene& scene) {
    const Vec3 line = direction_of_line(scene);
    const double offset = scene.approach.offset;
    if (never_meets_line(scene)) return offset * Vec3(line.y(), -line.x(), 0.0);
    const Vec3 origin = scene.barrier ? scene.barrier->origin : Vec3::Zero();
    return difference_as_written(offset, origin.dot(line), origin.head<2>().norm()) * line;
}

// Is the barrier the same all along its line?
bool is_endless(const Barrier& barrier) {
    const Element& element = barrier.elements.front();
    if (barrier.elements.size() > 1 || element.heading != barrier.heading) return false;
    if (const auto* plane = std::get_if<HalfSpace>(&element.shape)) return plane->normal.y() == 0.0;
    const auto* prism = std::get_if<Prism>(&element.shape);
    return prism != nullptr && std::isinf(prism->y_low()) && std::isinf(prism->y_high());
}

}  // namespace

void Scene::set_approach(const Approach& a) {
    require_not_negative("impact_speed", a.speed);
    if (!(a.angle >= 0.0 && a.angle <= std::numbers::pi))
        refuse("impact_angle", "within 0 and 180 deg", a.angle * 180.0 / std::numbers::pi);
    require_finite("impact_yaw", a.yaw);
    require_finite("impact_roll", a.roll);
    require_finite("impact_offset", a.offset);
    if (!(std::isfinite(a.standoff) && a.standoff >= 0.0))
        refuse("standoff", "finite and >= 0 m, or the vehicle would start inside the barrier", a.standoff);
    if (!duration && !(a.speed > 0.0)) refuse("duration", "given (s) where the vehicle stands still", "none");
    approach = a;
    const bool anywhere = !barrier || is_endless(*barrier);
    from_origin = anywhere && !never_meets_line(*this) ? foot_of_path(*this) : Vec3(Vec3::Zero());
    const Vec3 origin = barrier ? barrier->origin : Vec3::Zero();
    base = Vec3(origin.x(), origin.y(), 0.0) + from_origin;
}

Vec3 Scene::heading() const {
    const double yaw = yaw_of_path(*this);
    return {std::cos(yaw), std::sin(yaw), 0.0};
}

Vec3 Scene::towards() const {
    const bool along = std::abs(std::sin(approach.angle)) < tolerance::along_line;
    return barrier && !along ? Vec3(-barrier->normal()) : heading();
}

State Scene::initial_state() const {
    State state(*vehicle);
    start(state);
    return state;
}

void Scene::start(State& state) const {
    state.reset(*vehicle);
    if (barrier) state.was_near.assign(barrier->elements.size(), char{0});
    for (std::size_t i = 0; i < moving_count(); ++i) {
        const Element& element = barrier->elements[i];
        BodyState moving;
        moving.orientation = from_roll_pitch_yaw({0.0, 0.0, element.heading});
        moving.position =
            element.position +
            (barrier->origin.z() + barrier->moving_elements[i].mass_center_height) * Vec3::UnitZ();
        state.moving_elements.push_back(moving);
    }
    const double yaw = yaw_of_path(*this);
    const Vec3 heading = this->heading();
    const double total_yaw = yaw + approach.yaw;
    const Quat orientation = from_roll_pitch_yaw({approach.roll, 0.0, total_yaw});
    const Unit& first = vehicle->units.front();
    const Vec3 center =
        foot_of_path(*this) - from_origin + from_roll_pitch_yaw({0.0, 0.0, total_yaw}) * first.place();
    for (std::size_t u = 0; u < vehicle->units.size(); ++u) {
        BodyState& body = state.units[u].body;
        const Unit& unit = vehicle->units[u];
        body.orientation = orientation;
        body.position = center + orientation * (unit.place() - first.place());
        body.velocity = approach.speed * heading;
        state.energies.kinetic += kinetic_energy(unit.body, body);
    }
    if (approach.roll != 0.0 && settings.ground) raise_to_ground(*this, state);
    if (barrier) {
        place(*this, heading, state);
        const double nearest = nearest_gap(*this, state, {.anchors = true});
        const double rounding = 1e-15 * state.units[0].body.position.norm() + tolerance::initial_overlap;
        if (nearest < -rounding) refuse("initial gap of the vehicle to the barrier", ">= 0 m", nearest);
    }
    if (settings.ground)
        for (std::size_t u = 0; u < state.units.size(); ++u)
            state.energies.springs += spring_energy(vehicle->units[u], state.units[u].body, 0);
    state.next_step = tolerance::first_contact_step;
}

}  // namespace birm3d
