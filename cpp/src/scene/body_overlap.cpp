#include "scene/body_overlap.hpp"

#include <algorithm>

#include "kernels/detect.hpp"

namespace birm3d {

namespace {

constexpr int corners = 8;
constexpr int descent_steps = 60;
// Length of the first step inside the shape, relative to the box, and of each step relative to the one before.
constexpr double first_step = 0.25, next_step = 0.9;

// The i-th corner of the box, from its middle; beyond the last, the middle itself.
Vec3 start_of(const Box& box, int i) {
    if (i == corners) return Vec3::Zero();
    return {i & 1 ? box.half.x() : -box.half.x(), i & 2 ? box.half.y() : -box.half.y(),
            i & 4 ? box.half.z() : -box.half.z()};
}

// The overlap that a descent from `place` finds (m); places are relative to the box's middle. Outside the shape, it
// projects alternately onto the shape and onto the box. Inside, it steps against the normal by decreasing lengths.
double overlap_from(Vec3 place, const Shape& shape, const Placement& now, const Box& box) {
    double least_gap = 0.0, overlap = 0.0;
    double step = first_step * box.half.norm();
    for (int i = 0; i < descent_steps; ++i) {
        const Nearest found = nearest(shape, now.to_own(box.center + place));
        if (found.gap < least_gap) {
            least_gap = found.gap;
            overlap = (box.half - place.cwiseAbs()).minCoeff() - found.gap;
        }
        const Vec3 ahead = place - (std::max(found.gap, 0.0) + step) * now.direction_from_own(found.normal);
        place = ahead.cwiseMax(-box.half).cwiseMin(box.half);
        step *= next_step;
    }
    return overlap;
}

}  // namespace

double overlap_of_box(const Shape& shape, const Placement& now, const Box& box) {
    if (!within_reach(shape, now, box, 0.0)) return 0.0;
    double overlap = 0.0;
    for (int i = 0; i <= corners; ++i)
        overlap = std::max(overlap, overlap_from(start_of(box, i), shape, now, box));
    return overlap;
}

}  // namespace birm3d
