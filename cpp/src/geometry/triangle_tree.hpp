// A tree of bounding boxes: finds triangles near a point or along a line without testing all.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "geometry/triangle.hpp"

namespace birm3d {

class TriangleTree {
  public:
    TriangleTree() = default;
    // `slack` widens every box (m).
    TriangleTree(const std::vector<Triangle>& triangles, double slack);

    // Calls visit(i) for the triangles whose boxes are nearer to the box from `low` to `high` than sqrt(square), near
    // ones first. visit may lower `square`.
    template <class Visit>
    void near(const Vec3& low, const Vec3& high, double& square, const Visit& visit) const;

    // Calls visit(i) for all triangles whose boxes the points p + t d, 0 <= t <= longest, meet.
    template <class Visit>
    void along(const Vec3& p, const Vec3& d, double longest, const Visit& visit) const;

    const Vec3& low() const { return nodes_[0].low; }
    const Vec3& high() const { return nodes_[0].high; }

  private:
    // A leaf holds order_[first .. first + count); the children of another node stand at first and first + 1.
    struct Node {
        Vec3 low, high;
        std::size_t first, count;
    };
    static constexpr std::size_t leaf_size = 2;
    static constexpr std::size_t deepest = 128;

    void divide(std::size_t node, std::size_t first, std::size_t count,
                const std::vector<Triangle>& triangles, double slack);
    static double square_to(const Node& node, const Vec3& low, const Vec3& high) {
        return (node.low - high).cwiseMax(low - node.high).cwiseMax(0.0).squaredNorm();
    }

    std::vector<Node> nodes_;
    std::vector<std::size_t> order_;
};

template <class Visit>
void TriangleTree::near(const Vec3& low, const Vec3& high, double& square, const Visit& visit) const {
    struct Open {
        std::size_t node;
        double square;
    };
    std::array<Open, deepest> open;
    std::size_t n = 0;
    open[n++] = {0, square_to(nodes_[0], low, high)};
    while (n > 0) {
        const Open next = open[--n];
        if (!(next.square < square)) continue;
        const Node& node = nodes_[next.node];
        if (node.count > 0) {
            for (std::size_t i = 0; i < node.count; ++i)
                visit(order_[node.first + i]);
            continue;
        }
        const Open a{node.first, square_to(nodes_[node.first], low, high)};
        const Open b{node.first + 1, square_to(nodes_[node.first + 1], low, high)};
        const bool a_first = a.square <= b.square;
        open[n++] = a_first ? b : a;
        open[n++] = a_first ? a : b;
    }
}

template <class Visit>
void TriangleTree::along(const Vec3& p, const Vec3& d, double longest, const Visit& visit) const {
    const auto meets = [&](const Node& node) {
        double from = 0.0, to = longest;
        for (int k = 0; k < 3; ++k) {
            if (d[k] == 0.0) {
                if (p[k] < node.low[k] || p[k] > node.high[k]) return false;
                continue;
            }
            const double a = (node.low[k] - p[k]) / d[k], b = (node.high[k] - p[k]) / d[k];
            from = std::max(from, std::min(a, b));
            to = std::min(to, std::max(a, b));
        }
        return from <= to;
    };
    std::array<std::size_t, deepest> open;
    std::size_t n = 0;
    open[n++] = 0;
    while (n > 0) {
        const Node& node = nodes_[open[--n]];
        if (!meets(node)) continue;
        if (node.count > 0) {
            for (std::size_t i = 0; i < node.count; ++i)
                visit(order_[node.first + i]);
            continue;
        }
        open[n++] = node.first + 1;
        open[n++] = node.first;
    }
}

}  // namespace birm3d
