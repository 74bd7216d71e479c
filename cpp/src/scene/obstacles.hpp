// What the units of a scene can touch, and where it stands seen from one of them.
#pragma once

#include <vector>

#include "birm3d/geometry/shape.hpp"
#include "birm3d/scene/scene.hpp"
#include "geometry/placement.hpp"

namespace birm3d {

// An obstacle within reach of a unit, seen from the unit's body axes, now and an instant before.
struct NearObstacle {
    std::size_t index = 0;  // of Scene::obstacles
    Placement now, before;
};

// Where an obstacle stands: free-standing segments have moved.
struct Pose {
    Mat3 rotation;  // own axes to the world
    Vec3 position;  // of the own axes' origin, world (m)
};
Pose pose_of(const Scene& scene, std::size_t obstacle, const State& state);

// The same, seen from a body.
Placement placement(const Pose& obstacle, const BodyState& seen_from);

// Motion of an obstacle as if it were part of the body that sees it: about the body's mass centre, body axes. Zero of
// what is fixed.
Twist obstacle_motion(const Scene& scene, std::size_t obstacle, const State& state,
                      const BodyState& seen_from);

// Those that any node or anchor of the unit can be nearer to than `margin`, in their order. `about`: memory.
void find_near(const Scene& scene, std::size_t unit, const State& before, const State& now, double margin,
               std::vector<std::size_t>& about, std::vector<NearObstacle>& near);

// Fastest any point of the unit moves (m/s).
double fastest_point(const Unit& unit, const BodyState& body);

// And of any free-standing segment of the barrier.
double fastest_segment(const Scene& scene, const State& state);

// Gap of the point that is nearest to an obstacle (m), infinite where there is none; exact, so that it does not hang on
// how nodes are blocked. The ground counts only with `ground`; of the points, nodes and anchors as asked.
struct Nearness {
    bool ground = false;
    bool nodes = true;
    bool anchors = false;
};
double nearest_gap(const Scene& scene, const State& state, const Nearness& what);

}  // namespace birm3d
