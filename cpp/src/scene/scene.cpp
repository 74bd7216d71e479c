#include "birm3d/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"
#include "geometry/prism_nearest.hpp"

namespace birm3d {

namespace {

void add_to(Hash& hash, const Wheel& wheel) {
    const Suspension& suspension = wheel.suspension;
    hash.add(wheel.center);
    for (const double number :
         {wheel.radius, wheel.breakaway, wheel.travel, wheel.steering_time, wheel.tread_radius,
          wheel.camber_ratio, wheel.rolling_resistance, suspension.stiffness, suspension.damping,
          suspension.at_rest, suspension.bump, suspension.roll_ratio})
        hash.add(number);
}

void add_to(Hash& hash, const Joint& joint) {
    for (const double number : {static_cast<double>(joint.kind), static_cast<double>(joint.leading),
                                static_cast<double>(joint.trailing), joint.roll_limit})
        hash.add(number);
    hash.add(joint.place_on_leading);
    hash.add(joint.place_on_trailing);
    for (const SlideKnot& knot : joint.slide)
        hash.add(knot.slip), hash.add(knot.force);
}

void add_to(Hash& hash, const HalfSpace& plane) {
    hash.add(plane.normal);
    hash.add(plane.offset);
}
void add_to(Hash& hash, const Post& post) {
    hash.add(post.radius);
    hash.add(post.height);
    if (post.opens) hash.add(*post.opens);
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

void add_to(Hash& hash, const Barrier& barrier) {
    hash.add(barrier.friction);
    hash.add(barrier.origin);
    hash.add(barrier.heading);
    for (const Element& element : barrier.elements) {
        hash.add(static_cast<double>(element.shape.index()));
        std::visit([&](const auto& shape) { add_to(hash, shape); }, element.shape);
        hash.add(element.position);
        hash.add(element.heading);
        if (element.part_of) hash.add(static_cast<double>(*element.part_of));
        if (element.upright) hash.add(-1.0);  // no index of an element
        if (element.draws_in_above) hash.add(-2.0);
    }
    if (barrier.free_standing) {
        hash.add(barrier.free_standing->density);
        hash.add(barrier.free_standing->ground_friction);
        hash.add(static_cast<double>(barrier.free_standing->joint));
    }
    if (barrier.yielding)
        for (const double number :
             {barrier.yielding->mass, barrier.yielding->inertia, barrier.yielding->plastic_moment})
            hash.add(number);
}

// Does a segment continue the segment before it? Its low end is no surface, and stands at the other's high end.
bool continues(const Obstacle& segment, const Obstacle& before) {
    const auto *prism = std::get_if<Prism>(&segment.shape), *last = std::get_if<Prism>(&before.shape);
    if (prism == nullptr || last == nullptr) return false;
    if (!std::isfinite(prism->y_low()) || !std::isfinite(last->y_high()) || prism->low_end_is_surface())
        return false;
    const auto end = [](const Obstacle& one, double y) {
        return Vec3(one.position + one.rotation * (y * Vec3::UnitY()));
    };
    return (end(segment, prism->y_low()) - end(before, last->y_high())).norm() < tolerance::abutting;
}

}  // namespace

Scene::Scene(std::shared_ptr<const Vehicle> vehicle_, std::shared_ptr<const Barrier> barrier_,
             const Approach& approach_, const Settings& settings_, std::optional<double> duration_)
    : vehicle(std::move(vehicle_)), barrier(std::move(barrier_)), settings(settings_), duration(duration_) {
    require_valid(settings);
    if (!vehicle || vehicle->units.empty()) refuse("vehicle", "at least one unit", 0.0);
    set_approach(approach_);
    if (duration) require_positive("duration", *duration);
    if (duration && *duration > tolerance::most_rows * settings.output_interval)
        refuse("output_interval",
               ">= duration / " + to_text(tolerance::most_rows) + " = " +
                   to_text(*duration / tolerance::most_rows, 3) + " s",
               settings.output_interval);
    if (!duration && !barrier) refuse("duration", "given (s) where there is no barrier", "none");
    if (barrier)
        for (const Element& element : barrier->elements)
            obstacles.push_back({element.shape, element.rotation(),
                                 element.position + barrier->origin.z() * Vec3::UnitZ(), barrier->friction});
    if (slides() && !settings.ground) refuse("ground", "True where the barrier is free-standing", "False");
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        const auto& whole = barrier->elements[i].part_of;
        const bool joined = i > 0 && moving_count() == 0 && continues(obstacles[i], obstacles[i - 1]);
        obstacles[i].structure = whole    ? obstacles[*whole].structure
                                 : joined ? obstacles[i - 1].structure
                                          : i;
        obstacles[i].element = whole.value_or(i);
        if (barrier->elements[i].draws_in_above)
            obstacles[i].top_edge = top_edge_of(std::get<Prism>(obstacles[i].shape));
    }
    joints = vehicle->joints;
    if (slides() && barrier->free_standing->joint == SegmentJoint::pinned)
        for (std::size_t i = 1; i < moving_count(); ++i) {
            const MovingElement &one = barrier->moving_elements[i - 1], &next = barrier->moving_elements[i];
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
    map = ObstacleMap(obstacles, moving_count());
    thinnest = infinity;
    for (const Obstacle& obstacle : obstacles)
        thinnest =
            std::min({thinnest, thickness(obstacle.shape), 2.0 * bounds(obstacle.shape).half.minCoeff()});
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
            for (const BlockColumn* column :
                 {&b.node_x, &b.node_y, &b.node_z, &b.anchor_x, &b.anchor_y, &b.anchor_z, &b.k_unloading})
                hash.add(*column);
        if (unit.trusses.recovers)
            for (const TrussBlock& b : unit.trusses.block)
                hash.add(b.recovery);
        for (const BlockColumn& share : unit.trusses.friction_share)
            hash.add(share);
        for (const Hinge& hinge : unit.trusses.hinge) {
            hash.add(hinge.deflection);
            hash.add(hinge.slope_change);
        }
        hash.add(unit.trusses.rate_sensitivity);
        hash.add(unit.trusses.indentation_length);
        for (const TireNode& node : unit.trusses.tire_nodes) {
            hash.add(node.tread_r);
            hash.add(node.tread_t);
            hash.add(static_cast<double>(node.wheel));
        }
        for (const Wheel& wheel : unit.wheels)
            add_to(hash, wheel);
        for (const Box& box : unit.core)
            hash.add(box.center), hash.add(box.half);
    }
    for (const Joint& joint : vehicle->joints)
        add_to(hash, joint);
    if (barrier) add_to(hash, *barrier);
    return hash.value();
}

}  // namespace birm3d
