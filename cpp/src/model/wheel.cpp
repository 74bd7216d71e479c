#include "birm3d/model/wheel.hpp"

namespace birm3d {

Vec3 lowest_point(const Wheel& wheel, const Mat3& R, double raised) {
    const Vec3 axle = R.col(1);
    const Vec3 down = -Vec3::UnitZ() + axle.z() * axle;  // downwards within the wheel's plane
    const double size = down.norm();
    const Vec3 center = R * (wheel.center + raised * Vec3::UnitZ());
    // A wheel that lies flat touches all around: its centre stands for the rim.
    const double rim = size > 1e-9 ? (wheel.radius - wheel.tread_radius) / size : 0.0;
    return center + rim * down - wheel.tread_radius * Vec3::UnitZ();
}

}  // namespace birm3d
