#include "birm3d/sim/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "birm3d/base/error.hpp"
#include "birm3d/base/rotation.hpp"
#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/kernels/tires.hpp"
#include "birm3d/sim/obstacles.hpp"
#include "birm3d/sim/panel_dents.hpp"
#include "recorder_rows.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void add_to(Hash& hash, const HalfSpace& plane) {
    hash.add(plane.normal);
    hash.add(plane.offset);
}
void add_to(Hash& hash, const Post& post) {
    hash.add(post.radius);
    hash.add(post.height);
}
void add_to(Hash& hash, const Prism& prism) {
    for (const auto* edges : {&prism.edges(), &prism.covered_edges()})
        for (const PrismEdge& edge : *edges)
            for (const double number : {edge.x, edge.z, edge.tx, edge.tz, edge.low, edge.high})
                hash.add(number);
    hash.add(prism.y_low());
    hash.add(prism.y_high());
    hash.add((prism.low_end_is_surface() ? 1.0 : 0.0) + (prism.high_end_is_surface() ? 2.0 : 0.0));
}
void add_to(Hash& hash, const TriangleMesh& mesh) {
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
        for (const Vec3& corner : mesh.corners(i))
            hash.add(corner);
}

// How far the barrier reaches along `direction` (m).
double extent(const std::vector<Obstacle>& elements, const Vec3& direction) {
    double most = -infinity;
    for (const Obstacle& element : elements) {
        const Vec3 own = element.rotation.transpose() * direction;
        if (const auto* plane = std::get_if<HalfSpace>(&element.shape)) {
            const bool ends = (own - plane->normal).norm() < 1e-12;
            most = std::max(most, ends ? element.position.dot(direction) + plane->offset : infinity);
            continue;
        }
        const Box box = bounds(element.shape);
        double reach = element.position.dot(direction);
        for (int i = 0; i < 3; ++i)
            if (std::abs(own[i]) > 1e-12) reach += own[i] * box.center[i] + std::abs(own[i]) * box.half[i];
        most = std::max(most, reach);
    }
    return most;
}

void move(State& state, const Vec3& way) {
    for (UnitState& unit : state.units)
        unit.body.position += way;
}

// A vehicle that is rolled stands on what is then its lowest point.
void raise_to_ground(const Scene& scene, State& state) {
    double lowest = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const Unit& unit = scene.vehicle->units[u];
        std::vector<RigidContact> wheels;
        find_tire_contacts(unit, u, state.units[u].body, wheels);
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

// Does a segment of a wall go on where the one before it ends?
bool continues(const Shape& shape) {
    const auto* prism = std::get_if<Prism>(&shape);
    return prism != nullptr && std::isfinite(prism->y_low()) && !prism->low_end_is_surface();
}

// Beside a post a bowed front is drawn in before the post touches a node: back to before that.
void stand_back(const Scene& scene, const Vec3& heading, State& state) {
    constexpr double deepest = 0.3;
    constexpr int most_steps = 50;
    for (int i = 0; i < most_steps; ++i) {
        const double overlap = overlap_of_dents(scene, state, deepest);
        if (overlap == 0.0) return;
        move(state, -(overlap + tolerance::touching_gap) * heading);
    }
}

// Moves the vehicle of `state` along its path, forward or back, until its nearest point stands `standoff` before the
// barrier. A path that leads past the barrier starts where the barrier begins.
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
    double front = -infinity, rear = infinity;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const BodyState& body = state.units[u].body;
        const TrussMesh& mesh = scene.vehicle->units[u].trusses;
        const Mat3 R = body.orientation.toRotationMatrix();
        const auto reach = [&](const Vec3& point) {
            const double at = inward.dot(body.position + R * point);
            front = std::max(front, at), rear = std::min(rear, at);
        };
        for (std::size_t i = 0; i < mesh.count; ++i)
            reach(mesh.node(i));
        for (std::size_t i = 0; i < mesh.skin; ++i)
            reach(mesh.anchor(i));
    }
    const double pace = heading.dot(inward);
    const double to_plane = (first - scene.approach.standoff - front) / pace;
    move(state, to_plane * heading);
    const bool plane_only = elements.size() == 1 && std::holds_alternative<HalfSpace>(elements[0].shape);
    if (plane_only) return;

    // From there step by step by the distance that is certainly free.
    const double longest = (last - first + front - rear) / pace + scene.approach.standoff;
    double way = 0.0;
    constexpr int most_steps = 1000;
    for (int i = 0; i < most_steps && way <= longest; ++i) {
        const double free = nearest_gap(scene, state, {.anchors = true}) - scene.approach.standoff;
        move(state, free * heading);
        way += free;
        if (std::abs(free) < tolerance::initial_overlap * 1e-3) break;
    }
    if (way <= longest) {
        stand_back(scene, heading, state);
        return;
    }
    move(state, -way * heading);
}

// At barrier heading 0 the line runs along +y: the path (sin, cos) meets it at the impact angle.
double yaw_of_path(const Scene& scene) {
    const double barrier_heading = scene.barrier ? scene.barrier->heading : 0.0;
    return barrier_heading + 0.5 * std::numbers::pi - scene.approach.angle;
}

}  // namespace

Scene::Scene(std::shared_ptr<const Vehicle> vehicle_, std::shared_ptr<const Barrier> barrier_,
             const Approach& approach_, const Settings& settings_, std::optional<double> duration_)
    : vehicle(std::move(vehicle_)), barrier(std::move(barrier_)), settings(settings_), duration(duration_) {
    require_valid(settings);
    if (!vehicle || vehicle->units.empty()) refuse("vehicle", "at least one unit", 0.0);
    set_approach(approach_);
    if (duration) require_positive("duration", *duration);
    if (duration && *duration > most_rows * settings.output_interval)
        refuse("output_interval",
               ">= duration / " + to_text(most_rows) + " = " + to_text(*duration / most_rows, 3) + " s",
               settings.output_interval);
    if (!duration && !barrier) refuse("duration", "given (s) where there is no barrier", "none");
    if (barrier)
        for (const Element& element : barrier->elements)
            obstacles.push_back({element.shape,
                                 Eigen::AngleAxisd(element.heading, Vec3::UnitZ()).toRotationMatrix(),
                                 element.position, barrier->friction, 0});
    if (free_segments() > 0 && !settings.ground)
        refuse("ground", "True where the barrier is free-standing", "False");
    for (std::size_t i = 0; i < obstacles.size(); ++i)
        obstacles[i].structure =
            i > 0 && free_segments() == 0 && continues(obstacles[i].shape) ? obstacles[i - 1].structure : i;
    joints = vehicle->joints;
    if (free_segments() > 0 && barrier->free_standing->joint == SegmentJoint::pinned)
        for (std::size_t i = 1; i < free_segments(); ++i) {
            const Segment &one = barrier->segments[i - 1], &next = barrier->segments[i];
            const std::size_t body = vehicle->units.size() + i;
            joints.push_back({JointKind::pinned, body - 1, body, Vec3(0.0, one.half_length, 0.0),
                              Vec3(0.0, -next.half_length, 0.0), 0.0});
        }
    ground = obstacles.size();
    for (const Unit& unit : vehicle->units)
        skin_meets_ground.push_back(settings.ground && stands_on_wheels(unit));
    if (std::any_of(skin_meets_ground.begin(), skin_meets_ground.end(), [](char meets) { return meets; }))
        obstacles.push_back(
            {HalfSpace{Vec3::UnitZ(), 0.0}, Mat3::Identity(), Vec3::Zero(), settings.mu_body, ground});
    map = ObstacleMap(obstacles, free_segments());
    thinnest = std::numeric_limits<double>::infinity();
    for (const Obstacle& obstacle : obstacles)
        thinnest =
            std::min({thinnest, thickness(obstacle.shape), 2.0 * bounds(obstacle.shape).half.minCoeff()});
}

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
}

Vec3 Scene::heading() const {
    const double yaw = yaw_of_path(*this);
    return {std::cos(yaw), std::sin(yaw), 0.0};
}

Vec3 Scene::towards() const {
    const bool along = std::abs(std::sin(approach.angle)) < tolerance::along_line;
    return barrier && !along ? Vec3(-barrier->normal()) : heading();
}

double Scene::reference_speed() const {
    return std::max(approach.speed, tolerance::slowest_reference_speed);
}

double Scene::full_friction_speed() const {
    return tolerance::full_friction_speed * reference_speed();
}

std::uint64_t Scene::fingerprint() const {
    Hash hash;
    for (const Unit& unit : vehicle->units) {
        hash.add(unit.body.mass);
        for (int column = 0; column < 3; ++column)
            hash.add(Vec3(unit.body.inertia.col(column)));
        hash.add(unit.mass_center_height);
        hash.add(unit.offset);
        for (const TrussBlock& b : unit.trusses.block)
            for (const Lanes* lane :
                 {&b.node_x, &b.node_y, &b.node_z, &b.anchor_x, &b.anchor_y, &b.anchor_z, &b.k_unloading})
                hash.add(*lane);
        for (const Hinge& hinge : unit.trusses.hinge) {
            hash.add(hinge.deflection);
            hash.add(hinge.slope_change);
        }
        hash.add(unit.trusses.rate_sensitivity);
        hash.add(unit.trusses.dent_reach);
        for (const TreadNode& node : unit.trusses.tread) {
            hash.add(node.turn_r);
            hash.add(node.turn_t);
            hash.add(static_cast<double>(node.wheel));
        }
        for (const Wheel& wheel : unit.wheels) {
            hash.add(wheel.center);
            hash.add(wheel.radius);
        }
    }
    for (const Joint& joint : vehicle->joints) {
        hash.add(static_cast<double>(joint.kind));
        hash.add(static_cast<double>(joint.leading));
        hash.add(static_cast<double>(joint.trailing));
        hash.add(joint.place_on_leading);
        hash.add(joint.place_on_trailing);
        hash.add(joint.roll_limit);
    }
    if (barrier) {
        hash.add(barrier->friction);
        hash.add(barrier->origin);
        hash.add(barrier->heading);
        for (const Element& element : barrier->elements) {
            hash.add(static_cast<double>(element.shape.index()));
            std::visit([&](const auto& shape) { add_to(hash, shape); }, element.shape);
            hash.add(element.position);
            hash.add(element.heading);
        }
        if (barrier->free_standing) {
            hash.add(barrier->free_standing->density);
            hash.add(barrier->free_standing->ground_friction);
            hash.add(static_cast<double>(barrier->free_standing->joint));
        }
    }
    return hash.value();
}

State Scene::initial_state() const {
    State state(*vehicle);
    start(state);
    return state;
}

void Scene::start(State& state) const {
    state.reset(*vehicle);
    if (barrier) state.was_near.assign(barrier->elements.size(), char{0});
    for (std::size_t i = 0; i < free_segments(); ++i) {
        const Element& element = barrier->elements[i];
        BodyState segment;
        segment.orientation = from_roll_pitch_yaw({0.0, 0.0, element.heading});
        segment.position = element.position + barrier->segments[i].mass_center_height * Vec3::UnitZ();
        state.segments.push_back(segment);
    }
    const double barrier_heading = barrier ? barrier->heading : 0.0;
    const Vec3 origin = barrier ? barrier->origin : Vec3::Zero();
    const double yaw = yaw_of_path(*this);
    const Vec3 heading = this->heading();
    const Vec3 line(-std::sin(barrier_heading), std::cos(barrier_heading), 0.0);

    const double turn = yaw + approach.yaw;
    const Quat orientation = from_roll_pitch_yaw({approach.roll, 0.0, turn});
    const Unit& first = vehicle->units.front();
    // Zero of the line is the point nearest to the world's origin, wherever along it the elements stand.
    const Vec3 away(std::cos(barrier_heading), std::sin(barrier_heading), 0.0);
    const Vec3 zero = origin.dot(away) * away;
    // A path along the line never meets it: the offset is its distance, away from the traffic.
    const bool meets_line = std::abs(std::sin(approach.angle)) > 1e-12;
    const Vec3 foot = zero + approach.offset * (meets_line ? line : away);
    const Vec3 center = foot + from_roll_pitch_yaw({0.0, 0.0, turn}) * first.place();
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
    state.next_step = tolerance::first_contact_step;
}

}  // namespace birm3d
