#include <algorithm>
#include <cmath>

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

}  // namespace birm3d
