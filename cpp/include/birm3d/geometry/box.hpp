// A box along the axes, around some points: what the broad phase tests before it looks at them one by one.
#pragma once

#include <cmath>
#include <cstddef>

#include "birm3d/base/types.hpp"

namespace birm3d {

struct Box {
    Vec3 center = Vec3::Zero();
    Vec3 half = Vec3::Zero();  // edges

    // The box around this one and a point.
    Box with(const Vec3& point) const {
        const Vec3 low = (center - half).cwiseMin(point), high = (center + half).cwiseMax(point);
        return {0.5 * (low + high), 0.5 * (high - low)};
    }

    // The box around both.
    Box with(const Box& other) const {
        return with(other.center - other.half).with(other.center + other.half);
    }

    // The box around this one, whose axes are turned by `rotation` and begin at `origin`. Half widths may be infinite.
    Box placed(const Mat3& rotation, const Vec3& origin) const {
        constexpr double aligned = 1e-9;  // 0 times infinity would be NaN
        Box around{origin + rotation * center, Vec3::Zero()};
        for (int axis = 0; axis < 3; ++axis)
            for (int own = 0; own < 3; ++own)
                if (std::abs(rotation(axis, own)) > aligned)
                    around.half[axis] += std::abs(rotation(axis, own)) * half[own];
        return around;
    }

    // No point of it is further from the origin (m).
    double radius() const { return (center.cwiseAbs() + half).norm(); }

    // `point` gives the i-th of `count` >= 1 points.
    template <class Point>
    static Box around(std::size_t count, const Point& point) {
        Vec3 low = point(0);
        Vec3 high = low;
        for (std::size_t i = 1; i < count; ++i) {
            const Vec3 p = point(i);
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        return {0.5 * (low + high), 0.5 * (high - low)};
    }
};

}  // namespace birm3d
