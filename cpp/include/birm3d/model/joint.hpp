// Two rigid bodies joined at a point.
//
//   fifth_wheel  forces in three directions. The plate tilts about the leading body's s axis (pitch) and the
//                kingpin, the trailing body's t axis, turns in it (yaw); about the axis across both the plates
//                touch once the relative roll leaves +-roll_limit, and a moment is carried.
//   welded       all six held.
//   sliding      as welded, but the trailing body slides along the leading body's r axis. Up to a force nothing slides.
//                This force may depend on the slip, as that of bolts which fail after a travel.
//   pinned       of bodies that stand on the ground: forces along the ground; they turn about the vertical.
//
// The free rotations of a fifth wheel in their order, a Cardan joint: R_leading^T R_trailing = Ry(pitch) Rx(roll) Rz(yaw).
#pragma once

#include <cstddef>
#include <vector>

#include "birm3d/base/types.hpp"

namespace birm3d {

enum class JointKind { fifth_wheel, welded, sliding, pinned };

// A knot of the force that a sliding joint holds against the slip.
struct SlideKnot {
    double slip = 0.0;   // m, to either side
    double force = 0.0;  // N
};

struct Joint {
    JointKind kind = JointKind::fifth_wheel;
    std::size_t leading = 0;                // body whose axes define roll and pitch
    std::size_t trailing = 1;               // the other
    Vec3 place_on_leading = Vec3::Zero();   // body axes (m)
    Vec3 place_on_trailing = Vec3::Zero();  // body axes (m)
    double roll_limit = 0.0;                // rad; of a fifth wheel
    std::vector<SlideKnot> slide{};         // of a sliding joint; constant beyond the last knot
};

// Of the trailing body relative to the leading one (rad).
struct JointAngles {
    double roll = 0.0;
    double pitch = 0.0;
    double yaw = 0.0;
};

}  // namespace birm3d
