// The obstacles of a scene, and their positions in the axes of a unit.
#pragma once

#include <vector>

#include "birm3d/geometry/shape.hpp"
#include "birm3d/scene/scene.hpp"
#include "geometry/placement.hpp"

namespace birm3d {

// An obstacle within reach of a unit, in the unit's body axes, now and at the start of the step.
struct NearObstacle {
    std::size_t index = 0;  // of Scene::obstacles
    Placement now, before;
};

// Where an obstacle stands: moving elements have moved.
struct Pose {
    Mat3 rotation;  // own axes to the world
    Vec3 position;  // of the own axes' origin, world (m)
};
Pose pose_of(const Scene& scene, std::size_t obstacle, const State& state);

// The placement of a body relative to an obstacle.
Placement placement(const Pose& obstacle, const BodyState& observer);

// Motion of an obstacle about the mass centre of a body, in body axes. Zero for fixed obstacles.
Twist obstacle_motion(const Scene& scene, std::size_t obstacle, const State& state,
                      const BodyState& observer);

// Finds obstacles that any node or anchor of the unit can be nearer to than `margin`, by ascending index. `about`:
// memory.
void find_near(const Scene& scene, std::size_t unit, const State& before, const State& now, double margin,
               std::vector<std::size_t>& about, std::vector<NearObstacle>& near);

// Does any node of the unit push on the obstacle?
bool pushes_on(const UnitState& unit, std::size_t obstacle);

// Fastest any point of the unit moves (m/s).
double fastest_point(const Unit& unit, const BodyState& body);

// And of any moving element of the barrier.
double fastest_moving_element(const Scene& scene, const State& state);

// Gap of the point that is nearest to an obstacle (m); infinite if there is none. It is exact, so that it does not
// depend on the order of nodes in blocks. The flags choose nodes, anchors and the ground. Skin that an indentation draws in, or
// that hangs over a top edge and may lag inside the wall, is left out.
struct Nearness {
    bool ground = false;
    bool nodes = true;
    bool anchors = false;
};
double nearest_gap(const Scene& scene, const State& state, const Nearness& what);

}  // namespace birm3d
