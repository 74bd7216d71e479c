// Which panel each truss is of.
#include <algorithm>
#include <array>
#include <cmath>

#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

namespace {

Box box_around(const std::vector<Vec3>& points) {
    return Box::around(points.size(), [&](std::size_t i) { return points[i]; });
}

// Second trusses across the vehicle go in with a post before the side, as the side's own do. Those along it do not:
// the post slides past what resists lengthways.
bool is_across(const Vec3& direction) {
    return std::abs(direction.y()) > std::abs(direction.x());
}

// Panel of a truss with the direction `inward`: two for each axis, the positive direction first.
std::size_t panel_of(const Vec3& inward) {
    Eigen::Index axis = 0;
    inward.cwiseAbs().maxCoeff(&axis);
    return 2 * static_cast<std::size_t>(axis) + (inward[axis] < 0.0 ? 1 : 0);
}

}  // namespace

void TrussMesh::find_panels(const TrussInput& input) {
    std::array<std::vector<Vec3>, panels> nodes, anchors_of;
    std::array<std::vector<std::size_t>, panels> slots;
    panels_of.fill().assign(blocks, 0);
    for (std::size_t b = 0; b < blocks; ++b) {
        BlockColumn& panel_of_node = block.fill()[b].panel;
        for (std::size_t i = 0; i < nodes_in(b); ++i) {
            const std::size_t source = input_index[first[b] + i];
            const Vec3 direction = input.anchor[source] - input.node[source];
            const bool follows = b < skin_blocks || (b < shell_blocks && is_across(direction));
            const std::size_t p = follows ? panel_of(direction) : panels;  // of none of these
            panel_of_node[i] = static_cast<double>(p);
            panels_of.fill()[b] |= static_cast<std::uint8_t>(1U << p);
            if (!follows) continue;
            nodes[p].push_back(input.node[source]);
            anchors_of[p].push_back(input.anchor[source]);
            slots[p].push_back(b * block_size + i);
        }
        std::fill(panel_of_node.begin() + static_cast<std::ptrdiff_t>(nodes_in(b)), panel_of_node.end(),
                  panel_of_node[nodes_in(b) - 1]);
    }
    panels_of_group.fill().assign((blocks + group_size - 1) / group_size, 0);
    for (std::size_t b = 0; b < blocks; ++b)
        panels_of_group.fill()[b / group_size] |= panels_of[b];
    for (std::size_t p = 0; p < panels; ++p) {
        const double sign = p % 2 == 0 ? 1.0 : -1.0;
        panel[p] = {sign * Vec3::Unit(static_cast<Eigen::Index>(p / 2)), {}, {}, !nodes[p].empty()};
        if (!panel[p].any) continue;
        panel[p].box = box_around(nodes[p]);
        panel[p].anchors = box_around(anchors_of[p]);
        panel[p].outlines = outlines_of(nodes[p], panel[p].inward);
        const std::vector<double> heights = heights_above_edge(nodes[p], panel[p].inward);
        for (std::size_t k = 0; k < heights.size(); ++k)
            block.fill()[slots[p][k] / block_size].height_above_edge[slots[p][k] % block_size] = heights[k];
    }
}

}  // namespace birm3d
