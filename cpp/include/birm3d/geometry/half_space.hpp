// The flat wall: all points with normal . p <= offset are inside (paper Eq. 8 with a unit normal).
#pragma once

#include "birm3d/geometry/box.hpp"

namespace birm3d {

struct HalfSpace {
    Vec3 normal = -Vec3::UnitX();  // outward, unit
    double offset = 0.0;           // m

    // Signed distance of a point along the outward normal; negative = inside (m).
    double gap(const Vec3& p) const { return normal.dot(p) - offset; }

    const Vec3& normal_at(const Vec3&) const { return normal; }

    // Can any point of the box be nearer to the surface than `margin` (m)?
    bool within_reach(const Box& box, double margin) const {
        return gap(box.center) - normal.cwiseAbs().dot(box.half) < margin;
    }

    // The same surface seen from axes that stand at `position` and are turned by `rotation` (axes to world).
    HalfSpace in_axes(const Vec3& position, const Mat3& rotation) const {
        return {rotation.transpose() * normal, offset - normal.dot(position)};
    }
};

}  // namespace birm3d
