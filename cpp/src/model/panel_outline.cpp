#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

std::vector<Box> outlines_of(std::vector<Vec3> nodes, const Vec3& inward) {
    std::sort(nodes.begin(), nodes.end(),
              [&](const Vec3& a, const Vec3& b) { return inward.dot(a) < inward.dot(b); });
    const double outermost = inward.dot(nodes.front());
    std::vector<Box> outlines;
    Box box{nodes.front(), Vec3::Zero()};
    for (const Vec3& node : nodes) {
        const double deep = (inward.dot(node) - outermost) / outline_step;
        while (deep > static_cast<double>(outlines.size() + 1))
            outlines.push_back(box);
        box = box.with(node);
    }
    outlines.push_back(box);
    return outlines;
}

Box outline_at(const Panel& panel, double depth) {
    const double last = static_cast<double>(panel.outlines.size() - 1);
    const double place = std::clamp(depth / outline_step - 1.0, 0.0, last), whole = std::floor(place);
    const Box& here = panel.outlines[static_cast<std::size_t>(whole)];
    const Box& next = panel.outlines[static_cast<std::size_t>(std::min(whole + 1.0, last))];
    const double part = place - whole;
    return {here.center + part * (next.center - here.center), here.half + part * (next.half - here.half)};
}

std::vector<double> heights_above_edge(const std::vector<Vec3>& nodes, const Vec3& inward) {
    std::vector<double> heights(nodes.size(), 0.0);
    if (inward.z() != 0.0) return heights;
    const Eigen::Index along = inward.x() != 0.0 ? 1 : 0;
    std::vector<std::size_t> order(nodes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return nodes[a][along] < nodes[b][along]; });
    std::deque<std::size_t>
        lowest;  // nodes within reach that are lower than all after them, the lowest first
    std::size_t next = 0;
    for (const std::size_t k : order) {
        for (; next < order.size() && nodes[order[next]][along] <= nodes[k][along] + column_half_width;
             ++next) {
            while (!lowest.empty() && nodes[lowest.back()].z() >= nodes[order[next]].z())
                lowest.pop_back();
            lowest.push_back(order[next]);
        }
        while (nodes[lowest.front()][along] < nodes[k][along] - column_half_width)
            lowest.pop_front();
        heights[k] = nodes[k].z() - nodes[lowest.front()].z();
    }
    return heights;
}

}  // namespace birm3d
