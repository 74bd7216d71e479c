#include "geometry/triangle_tree.hpp"

#include <algorithm>
#include <numeric>

namespace birm3d {

namespace {

Vec3 middle(const Triangle& t) {
    return (t.corner[0] + t.corner[1] + t.corner[2]) / 3.0;
}

}  // namespace

TriangleTree::TriangleTree(const std::vector<Triangle>& triangles, double slack) : order_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    nodes_.emplace_back();
    divide(0, 0, order_.size(), triangles, slack);
}

// Halves, at the middle triangle along the longest edge of the box around the triangles' centres: the depth is
// the logarithm of their number.
void TriangleTree::divide(std::size_t node, std::size_t first, std::size_t count,
                          const std::vector<Triangle>& triangles, double slack) {
    Vec3 low = triangles[order_[first]].corner[0], high = low;
    Vec3 center_low = middle(triangles[order_[first]]), center_high = center_low;
    for (std::size_t i = first; i < first + count; ++i) {
        const Triangle& t = triangles[order_[i]];
        for (const Vec3& corner : t.corner) {
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
        }
        center_low = center_low.cwiseMin(middle(t));
        center_high = center_high.cwiseMax(middle(t));
    }
    nodes_[node].low = low.array() - slack;
    nodes_[node].high = high.array() + slack;
    if (count <= leaf_size) {
        nodes_[node].first = first;
        nodes_[node].count = count;
        return;
    }
    Eigen::Index axis;
    (center_high - center_low).maxCoeff(&axis);
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(begin, begin + static_cast<std::ptrdiff_t>(count), [&](std::size_t a, std::size_t b) {
        const double at_a = middle(triangles[a])[axis], at_b = middle(triangles[b])[axis];
        return at_a != at_b ? at_a < at_b : a < b;
    });
    const std::size_t children = nodes_.size();
    nodes_.resize(children + 2);
    nodes_[node].first = children;
    nodes_[node].count = 0;
    divide(children, first, count / 2, triangles, slack);
    divide(children + 1, first + count / 2, count - count / 2, triangles, slack);
}

}  // namespace birm3d
