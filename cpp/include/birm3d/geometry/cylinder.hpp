// An endless cylinder: all points within `radius` of a line are inside.
#pragma once

#include <cmath>

#include "birm3d/geometry/box.hpp"

namespace birm3d {

struct Cylinder {
    Vec3 point = Vec3::Zero();  // on the axis (m)
    Vec3 axis = Vec3::UnitZ();  // unit
    double radius = 1.0;        // m

    // From the axis to a point, at right angles to the axis (m).
    Vec3 radial(const Vec3& p) const {
        const Vec3 from = p - point;
        return from - from.dot(axis) * axis;
    }

    // Signed distance of a point along the outward normal; negative = inside (m).
    double gap(const Vec3& p) const { return radial(p).norm() - radius; }

    // Outward, of the surface nearest to a point; any direction will do for one on the axis.
    Vec3 normal_at(const Vec3& p) const {
        const Vec3 r = radial(p);
        const double size = r.norm();
        return size > 0.0 ? Vec3(r / size) : axis.unitOrthogonal();
    }

    // Can any point of the box be nearer to the surface than `margin` (m)?
    bool within_reach(const Box& box, double margin) const {
        return gap(box.center) - box.half.norm() < margin;
    }

    // The same surface seen from axes that stand at `position` and are turned by `rotation` (axes to world).
    Cylinder seen_from(const Vec3& position, const Mat3& rotation) const {
        return {rotation.transpose() * (point - position), rotation.transpose() * axis, radius};
    }
};

}  // namespace birm3d
