// Through which face a node came in. Beside an edge of an obstacle the nearest face to a node that is inside need not be
// the one that presses it: a node just below the top of a wall that goes in by more than that is nearer to the top.
#pragma once

#include <optional>
#include <span>

#include "birm3d/geometry/nearest.hpp"
#include "birm3d/scene/scene.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

// A face that a node went through, at the end of the step.
struct EnteredFace {
    std::size_t seen;    // which of the obstacles asked
    Nearest now;         // gap and outward normal, body axes
    Vec3 normal_before;  // of the same face an instant earlier, body axes
};

// Follows the node `place` (body axes, m) from where it stood with the body an instant before to where it is now,
// inside one of the obstacles `seen` (places in `near`). None where the face that is nearest now is as good: the node
// was inside before, or has slid past the end of the face. `nearest_now`: the one of the obstacles asked whose face that
// is, `normal_now` its normal (body axes).
std::optional<EnteredFace> entered_face(const Scene& scene, std::span<const NearObstacle> near,
                                        std::span<const std::size_t> seen, const Vec3& place,
                                        std::size_t nearest_now, const Vec3& normal_now);

}  // namespace birm3d
