// Finds the face through which a node entered an obstacle. Near an edge, that need not be the nearest face: a node
// just below the top of a wall may come in so far that the top is nearer.
#pragma once

#include <optional>
#include <span>

#include "birm3d/geometry/nearest.hpp"
#include "birm3d/scene/scene.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

// A face that a node went through, at the end of the step.
struct EnteredFace {
    std::size_t reachable_index;  // which of the `reachable` obstacles
    Nearest now;                  // gap and outward normal, body axes
    Vec3 normal_before;           // of the same face at the start of the step, body axes
};

// Follows the node `place` (body axes, m) through the step to where it is now, inside one of the obstacles
// `reachable` (indices in `near`). None if the nearest face is right: the node was inside before, or has slid past
// the end of the face. `nearest_now`: which of the obstacles is nearest now; `normal_now`: its normal (body axes);
// `pushes`: does the node's truss push?
std::optional<EnteredFace> entered_face(const Scene& scene, std::span<const NearObstacle> near,
                                        std::span<const std::size_t> reachable, const Vec3& place,
                                        std::size_t nearest_now, const Vec3& normal_now, bool pushes);

}  // namespace birm3d
