// Where a body stands as seen from a shape's own axes: own = rotation * p + position.
#pragma once

#include "birm3d/base/types.hpp"
#include "birm3d/geometry/half_space.hpp"

namespace birm3d {

struct Placement {
    Mat3 rotation = Mat3::Identity();  // from the body's axes to the shape's own
    Vec3 position = Vec3::Zero();      // of the body's origin, in own axes (m)

    Vec3 to_own(const Vec3& point) const { return rotation * point + position; }
    Vec3 direction_to_own(const Vec3& direction) const { return rotation * direction; }
    Vec3 from_own(const Vec3& point) const { return rotation.transpose() * (point - position); }
    Vec3 direction_from_own(const Vec3& direction) const { return rotation.transpose() * direction; }

    // A plane of the own axes in the body's.
    HalfSpace plane_from_own(const HalfSpace& plane) const {
        return {direction_from_own(plane.normal), plane.offset - plane.normal.dot(position)};
    }

    Placement inverse() const { return {rotation.transpose(), -(rotation.transpose() * position)}; }

    // First `first`, then this one.
    Placement after(const Placement& first) const {
        return {rotation * first.rotation, to_own(first.position)};
    }
};

}  // namespace birm3d
