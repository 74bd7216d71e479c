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

namespace birm3d {

namespace {

double nearest_gap(const Unit& unit, const BodyState& body, const Surface& face) {
    const Surface seen = seen_from(face, body.position, body.orientation.toRotationMatrix());
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < unit.trusses.count; ++i) {
        least = std::min({least, gap(seen, unit.trusses.node(i)), gap(seen, unit.trusses.anchor(i))});
    }
    return least;
}

// How far along its path the vehicle of `state` has to go, forward or back, until its nearest point stands
// `standoff` before the face (m).
double way_to(const Barrier& barrier, const Vehicle& vehicle, State state, const Vec3& heading,
              double standoff) {
    const auto nearest = [&](const Surface& face) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t u = 0; u < vehicle.units.size(); ++u)
            least = std::min(least, nearest_gap(vehicle.units[u], state.units[u].body, face));
        return least;
    };
    // To the plane that touches the barrier from the traffic's side.
    HalfSpace plane{barrier.normal(), barrier.normal().dot(barrier.origin)};
    if (const auto* pole = std::get_if<Cylinder>(&barrier.face)) plane.offset += pole->radius;
    const double to_plane = (nearest(plane) - standoff) / -heading.dot(plane.normal);
    if (std::holds_alternative<HalfSpace>(barrier.face)) return to_plane;

    // From there step by step by the distance that is certainly free. A path that leads past it starts at the plane.
    double way = to_plane;
    for (UnitState& unit : state.units)
        unit.body.position += to_plane * heading;
    constexpr int most_steps = 200;
    for (int i = 0; i < most_steps; ++i) {
        const double free = nearest(barrier.face) - standoff;
        way += free;
        for (UnitState& unit : state.units)
            unit.body.position += free * heading;
        if (std::abs(free) < tolerance::initial_overlap * 1e-3) return way;
    }
    return to_plane;
}

}  // namespace

Scene::Scene(std::shared_ptr<const Vehicle> vehicle_, std::shared_ptr<const Barrier> barrier_,
             const Approach& approach_, const Settings& settings_, std::optional<double> duration_)
    : vehicle(std::move(vehicle_)),
      barrier(std::move(barrier_)),
      approach(approach_),
      settings(settings_),
      duration(duration_) {
    require_valid(settings);
    if (!vehicle || vehicle->units.empty()) refuse("vehicle", "at least one unit", 0.0);
    require_not_negative("impact_speed", approach.speed);
    if (!(approach.angle > 0.0 && approach.angle < std::numbers::pi))
        refuse("impact_angle", "> 0 and < 180 deg", approach.angle * 180.0 / std::numbers::pi);
    require_finite("impact_offset", approach.offset);
    if (!(std::isfinite(approach.standoff) && approach.standoff >= 0.0))
        refuse("standoff", "finite and >= 0 m, or the vehicle would start inside the barrier",
               approach.standoff);
    if (duration) require_positive("duration", *duration);
    if (!duration && !barrier) refuse("duration", "given (s) where there is no barrier", "none");
    if (!duration && !(approach.speed > 0.0))
        refuse("duration", "given (s) where the vehicle stands still", "none");
}

double Scene::reference_speed() const {
    return std::max(approach.speed, tolerance::slowest_reference_speed);
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
        hash.add(static_cast<double>(barrier->face.index()));
        if (const auto* pole = std::get_if<Cylinder>(&barrier->face)) hash.add(pole->radius);
        hash.add(barrier->width);
        hash.add(barrier->height);
    }
    return hash.value();
}

State Scene::initial_state() const {
    State state(*vehicle);
    const double barrier_heading = barrier ? barrier->heading : 0.0;
    const Vec3 origin = barrier ? barrier->origin : Vec3::Zero();
    // At barrier heading 0 the line runs along +y: the path (sin, cos) meets it at the impact angle.
    const double yaw = barrier_heading + 0.5 * std::numbers::pi - approach.angle;
    const Vec3 heading(std::cos(yaw), std::sin(yaw), 0.0);
    const Vec3 line(-std::sin(barrier_heading), std::cos(barrier_heading), 0.0);

    for (std::size_t u = 0; u < vehicle->units.size(); ++u) {
        BodyState& body = state.units[u].body;
        const Unit& unit = vehicle->units[u];
        body.orientation = from_roll_pitch_yaw({0.0, 0.0, yaw});
        body.position = Vec3(origin.x(), origin.y(), 0.0) + approach.offset * line +
                        unit.mass_center_height * Vec3::UnitZ() + body.orientation * unit.offset;
        body.velocity = approach.speed * heading;
        state.energies.kinetic += kinetic_energy(unit.body, body);
    }
    if (barrier) {
        const double shift = way_to(*barrier, *vehicle, state, heading, approach.standoff);
        for (std::size_t u = 0; u < vehicle->units.size(); ++u) {
            state.units[u].body.position += shift * heading;
            const double nearest = nearest_gap(vehicle->units[u], state.units[u].body, barrier->face);
            const double rounding = 1e-15 * std::abs(shift) + tolerance::initial_overlap;
            if (nearest < -rounding) refuse("initial gap of the vehicle to the barrier", ">= 0 m", nearest);
        }
    }
    state.next_step = tolerance::first_contact_step;
    return state;
}

}  // namespace birm3d
