// A box along the axes, around some points: what the broad phase tests before it looks at them one by one.
#pragma once

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
