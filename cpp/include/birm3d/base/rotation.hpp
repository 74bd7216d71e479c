// Orientation of a body: the unit quaternion q that turns body axes r, s, t into world axes x, y, z.
// R(q) is the paper's Eq. 16: its columns are the body axes seen from the world.
#pragma once

#include "birm3d/base/types.hpp"

namespace birm3d {

// ISO 8855 angles in rad: yaw about t first, then pitch about s, then roll about r. Pitch is positive
// nose-down and lies within +-pi/2; roll and yaw within +-pi.
struct Angles {
    double roll = 0.0;
    double pitch = 0.0;
    double yaw = 0.0;
};

Angles roll_pitch_yaw(const Quat& q);
Quat from_roll_pitch_yaw(const Angles& angles);

// q rotated by the vector theta (body axes, rad) through the Cayley map,
//   q' = q * normalise(1, theta/2).
// It agrees with the exponential map to second order and needs no trigonometric function.
Quat cayley(const Quat& q, const Vec3& theta);

}  // namespace birm3d
