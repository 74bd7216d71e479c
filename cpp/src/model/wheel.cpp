#include "birm3d/model/wheel.hpp"

namespace birm3d {

Vec3 lowest_point(const Wheel& wheel, const Mat3& R, double raised) {
    const Vec3 axle = R.col(1);
    const Vec3 down = -Vec3::UnitZ() + axle.z() * axle;  // downwards within the wheel's plane
    const double size = down.norm();
    const Vec3 center = R * (wheel.center + raised * Vec3::UnitZ());
    // A wheel that lies flat touches all around: its centre stands for the rim.
    return size > 1e-9 ? Vec3(center + (wheel.radius / size) * down) : center;
}

}  // namespace birm3d
