#include "birm3d/base/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace birm3d {

Angles roll_pitch_yaw(const Quat& q) {
    const Mat3 R = q.toRotationMatrix();
    return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
            std::atan2(R(1, 0), R(0, 0))};
}

Quat from_roll_pitch_yaw(const Angles& a) {
    using Eigen::AngleAxisd;
    return AngleAxisd(a.yaw, Vec3::UnitZ()) * AngleAxisd(a.pitch, Vec3::UnitY()) *
           AngleAxisd(a.roll, Vec3::UnitX());
}

Quat cayley(const Quat& q, const Vec3& theta) {
    const Quat increment(1.0, 0.5 * theta.x(), 0.5 * theta.y(), 0.5 * theta.z());
    return (q * increment).normalized();
}

}  // namespace birm3d
