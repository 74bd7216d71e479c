// What a run is about: a vehicle, a barrier (or none), the start and the settings. Constant while running.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "birm3d/geometry/top_edge.hpp"
#include "birm3d/model/barrier.hpp"
#include "birm3d/model/settings.hpp"
#include "birm3d/model/vehicle.hpp"
#include "birm3d/scene/obstacle_map.hpp"
#include "birm3d/state/state.hpp"

namespace birm3d {

// The start: the vehicle comes along a straight path at `angle` to the barrier's line and stands `standoff` before
// its first touch.
struct Approach {
    double speed = 0.0;   // m/s, >= 0
    double angle = 0.0;   // rad between path and barrier line, in [0, pi]; pi/2 = head-on
    double offset = 0.0;  // m along the barrier's line, where the path of the mass centre meets it, from the
                          // line's point nearest to the world's origin; of a path along the line its
                          // distance from it, away from the traffic
    double standoff = 0.0;  // m between the nearest node and the barrier, >= 0
    double yaw = 0.0;       // rad by which the nose points to the left of the path
    double roll = 0.0;      // rad

    bool operator==(const Approach&) const = default;
};

// A body that the vehicle can touch: an element of the barrier, or the ground.
struct Obstacle {
    Shape shape;                       // own axes
    Mat3 rotation = Mat3::Identity();  // own axes to those of the run, at the start
    Vec3 position = Vec3::Zero();      // of the own axes' origin, the same (m)
    double friction = 0.0;
    // Indices of the first obstacle that this one is joined to, and of the element that its loads are added to. Both
    // are its own index where it stands alone.
    std::size_t structure = 0, element = 0;
    std::optional<TopEdge> top_edge = {};  // of a face that draws in the skin above it
};

struct Scene {
    // Refuses what can not be run; see Approach and require_valid(Settings).
    Scene(std::shared_ptr<const Vehicle> vehicle, std::shared_ptr<const Barrier> barrier,
          const Approach& approach, const Settings& settings, std::optional<double> duration);

    std::shared_ptr<const Vehicle> vehicle;
    std::shared_ptr<const Barrier> barrier;  // may be absent
    Approach approach;
    Settings settings;
    std::optional<double> duration;  // s; absent: until the outcome is decided

    std::vector<Joint> joints;        // the vehicle's, then the pins between free-standing segments
    std::vector<Obstacle> obstacles;  // the barrier's elements in their order, then the ground
    std::size_t ground;               // place of the ground among them; beyond the last where there is none
    ObstacleMap map;                  // of the obstacles
    double thinnest;                  // no obstacle is thinner, from any side (m)
    std::vector<char> skin_meets_ground;  // (units) those that stand on wheels, where there is ground

    // How many of the obstacles, from the first, can move: all of the barrier's or none.
    std::size_t moving_count() const { return barrier ? barrier->moving_elements.size() : 0; }
    // Do they slide on the ground?
    bool slides() const { return barrier && barrier->free_standing; }
    // Do they tilt about their centres of rotation?
    bool tilts() const { return barrier && barrier->yielding; }

    State initial_state() const;
    void start(State& state) const;  // the same in the memory of a state of the vehicle

    // Another start; refuses what the constructor refuses.
    void set_approach(const Approach& approach);

    // Origin of the axes of the run, which are parallel to the world's (m, world, on the ground). State, record and
    // obstacles are in these axes, so that a barrier far from the world's origin costs no digits. Histories are in
    // world axes. The origin is the barrier's; for a barrier without end it is where the path meets the barrier's
    // line.
    Vec3 base = Vec3::Zero();
    Vec3 from_origin = Vec3::Zero();  // of the barrier to the base, along the line (m)

    // Hash of the vehicle and the barrier: equal for equal scenes, wherever they were made.
    std::uint64_t fingerprint() const;

    // Unit vectors along the ground: where the vehicle's path leads, and square to the barrier's line away from the
    // traffic. The second is the first where there is no barrier or the path runs along the line.
    Vec3 heading() const;
    Vec3 towards() const;

    // Velocity against which errors are judged (m/s).
    double reference_speed() const;

    // Sliding speed from which on friction is whole; see kernels/friction.hpp (m/s).
    double full_friction_speed() const;
};

}  // namespace birm3d
