#include "birm3d/model/truss_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

void require_valid(const TrussInput& input, std::size_t wheels) {
    const std::size_t n = input.node.size();
    require_not_negative("rate_sensitivity", input.rate_sensitivity);
    require_not_negative("dent_reach", input.dent_reach);
    if (n == 0) refuse("nodes", "at least 1", 0.0);
    const auto same_size = [n](const char* name, std::size_t size) {
        if (size != n)
            refuse(name, std::to_string(n) + " entries, one for each node", static_cast<double>(size));
    };
    same_size("anchors", input.anchor.size());
    same_size("curve_of", input.curve_of.size());
    same_size("scale", input.scale.size());
    if (!input.wheel_of.empty()) same_size("wheel_of", input.wheel_of.size());
    for (std::size_t i = 0; i < input.wheel_of.size(); ++i)
        if (input.wheel_of[i] < -1 || input.wheel_of[i] >= static_cast<int>(wheels))
            refuse("wheel_of[" + std::to_string(i) + "]",
                   "-1 or below " + std::to_string(wheels) + ", the number of wheels",
                   static_cast<double>(input.wheel_of[i]));

    for (std::size_t c = 0; c < input.curve.size(); ++c)
        require_valid(input.curve[c], input.curve.size() == 1 ? "" : "curve[" + std::to_string(c) + "] ");
    for (std::size_t i = 0; i < n; ++i) {
        const std::string at = "[" + std::to_string(i) + "]";
        if (!input.node[i].allFinite()) refuse("nodes" + at, "finite", "a coordinate that is not");
        if (!input.anchor[i].allFinite()) refuse("anchors" + at, "finite", "a coordinate that is not");
        const double length = (input.node[i] - input.anchor[i]).norm();
        if (!(length >= tolerance::truss_length))
            refuse("truss length" + at, ">= " + to_text(tolerance::truss_length) + " m", length);
        if (input.curve_of[i] >= input.curve.size())
            refuse("curve_of" + at, "< " + std::to_string(input.curve.size()),
                   static_cast<double>(input.curve_of[i]));
        require_not_negative(("scale" + at).c_str(), input.scale[i]);
    }
}

// Interleaved bits of the three coordinates: near in space, near in order.
std::uint64_t morton_code(const Vec3& p, const Vec3& low, double inverse_size) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double unit = std::clamp((p[axis] - low[axis]) * inverse_size, 0.0, 1.0);
        const auto cell = static_cast<std::uint64_t>(unit * 2097151.0);  // 21 bits
        for (int bit = 0; bit < 21; ++bit)
            code |= ((cell >> bit) & 1U) << (3 * bit + axis);
    }
    return code;
}

Box box_around(const std::vector<Vec3>& points) {
    return Box::around(points.size(), [&](std::size_t i) { return points[i]; });
}

// Of those points that `chosen` names.
std::vector<std::size_t> spatial_order(const std::vector<Vec3>& all, const std::vector<std::size_t>& chosen) {
    std::vector<Vec3> points;
    for (const std::size_t i : chosen)
        points.push_back(all[i]);
    const Box box = box_around(points);
    const Vec3 low = box.center - box.half;
    const double size = 2.0 * box.half.maxCoeff();
    const double inverse_size = size > 0.0 ? 1.0 / size : 0.0;

    std::vector<std::uint64_t> code(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        code[i] = morton_code(points[i], low, inverse_size);
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return code[a] < code[b]; });
    for (std::size_t& place : order)
        place = chosen[place];
    return order;
}

// Of a truss that points `inward`: 2 for each axis, the positive way first.
std::size_t panel_of(const Vec3& inward) {
    Eigen::Index axis = 0;
    inward.cwiseAbs().maxCoeff(&axis);
    return 2 * static_cast<std::size_t>(axis) + (inward[axis] < 0.0 ? 1 : 0);
}

Box box_around(const Lanes& x, const Lanes& y, const Lanes& z) {
    return Box::around(lanes, [&](std::size_t i) { return Vec3(x[i], y[i], z[i]); });
}

}  // namespace

TrussMesh::TrussMesh(const TrussInput& input, const std::vector<Wheel>& wheels) {
    require_valid(input, wheels.size());
    rate_sensitivity = input.rate_sensitivity;
    dent_reach = input.dent_reach;
    count = input.node.size();
    std::vector<std::size_t> of_skin, of_tires;
    for (std::size_t i = 0; i < count; ++i)
        (input.wheel_of.empty() || input.wheel_of[i] < 0 ? of_skin : of_tires).push_back(i);
    skin = of_skin.size();
    if (skin == 0) refuse("nodes of the skin", "at least 1", 0.0);
    skin_blocks = (skin + lanes - 1) / lanes;
    blocks = skin_blocks + (of_tires.size() + lanes - 1) / lanes;
    for (const TrussCurve& curve : input.curve)
        hinges = std::max(hinges, curve.slope.size());

    input_index = spatial_order(input.node, of_skin);
    if (!of_tires.empty()) {
        const std::vector<std::size_t> order = spatial_order(input.node, of_tires);
        input_index.insert(input_index.end(), order.begin(), order.end());
    }
    anchors = Box::around(skin, [&](std::size_t i) { return input.anchor[input_index[i]]; });
    block.resize(blocks);
    hinge.resize(blocks * hinges);
    for (std::size_t b = 0; b < blocks; ++b) {
        const bool on_skin = b < skin_blocks;
        const std::size_t first = on_skin ? b * lanes : skin + (b - skin_blocks) * lanes;
        const std::size_t end = on_skin ? skin : count;
        for (std::size_t i = 0; i < lanes; ++i)
            fill_lane(input, input_index[std::min(first + i, end - 1)], first + i >= end, b, i);
        add_stiffness(block[b]);
        node_box.push_back(box_around(block[b].node_x, block[b].node_y, block[b].node_z));
        anchor_box.push_back(box_around(block[b].anchor_x, block[b].anchor_y, block[b].anchor_z));
    }
    find_panels();
    find_tread(input, wheels);
}

void TrussMesh::find_tread(const TrussInput& input, const std::vector<Wheel>& wheels) {
    for (std::size_t truss = skin; truss < count; ++truss) {
        const std::size_t source = input_index[truss];
        const auto w = static_cast<std::size_t>(input.wheel_of[source]);
        const Vec3 d = input.node[source] - wheels[w].center;
        tread.push_back({d.z() / wheels[w].radius, -d.x() / wheels[w].radius, w});
    }
}

void TrussMesh::find_panels() {
    std::array<std::vector<Vec3>, panels> nodes;
    panels_of.assign(blocks, 0);
    for (std::size_t truss = 0; truss < skin; ++truss) {
        const std::size_t p = panel_of(anchor(truss) - node(truss));
        block[truss / lanes].panel[truss % lanes] = static_cast<double>(p);
        panels_of[truss / lanes] |= static_cast<std::uint8_t>(1U << p);
        nodes[p].push_back(node(truss));
    }
    for (std::size_t padding = skin; padding < skin_blocks * lanes; ++padding)
        block[padding / lanes].panel[padding % lanes] = block[skin_blocks - 1].panel[(skin - 1) % lanes];
    for (std::size_t b = skin_blocks; b < blocks; ++b)
        block[b].panel.fill(static_cast<double>(panels));  // of none
    for (std::size_t p = 0; p < panels; ++p) {
        const double way = p % 2 == 0 ? 1.0 : -1.0;
        panel[p] = {way * Vec3::Unit(static_cast<Eigen::Index>(p / 2)), {}, !nodes[p].empty()};
        if (panel[p].any) panel[p].box = box_around(nodes[p]);
    }
}

void TrussMesh::add_stiffness(const TrussBlock& trusses) {
    double count_of_block = 0.0;
    StiffnessMoments sum;
    for (std::size_t i = 0; i < lanes; ++i) {
        const double k = trusses.k_unloading[i];
        const Vec3 r(trusses.node_x[i], trusses.node_y[i], trusses.node_z[i]);
        if (k > 0.0) count_of_block += 1.0;
        sum.total += k;
        sum.second += k * r * r.transpose();
    }
    pushable.push_back(count_of_block);
    moments.push_back(sum);
}

void TrussMesh::fill_lane(const TrussInput& input, std::size_t source, bool padding, std::size_t b,
                          std::size_t i) {
    const Vec3& node = input.node[source];
    const Vec3& anchor = input.anchor[source];
    const double scale = padding ? 0.0 : input.scale[source];
    const TrussCurve& curve = input.curve[input.curve_of[source]];
    const bool on_skin = b < skin_blocks;
    reach = std::max({reach, node.norm(), on_skin ? anchor.norm() : 0.0});

    TrussBlock& to = block[b];
    to.node_x[i] = node.x(), to.node_y[i] = node.y(), to.node_z[i] = node.z();
    to.anchor_x[i] = anchor.x(), to.anchor_y[i] = anchor.y(), to.anchor_z[i] = anchor.z();
    to.length[i] = (node - anchor).norm();
    to.k_unloading[i] = scale * curve.k_unloading;
    to.compliance[i] = to.k_unloading[i] > 0.0 ? 1.0 / to.k_unloading[i] : 0.0;
    double slope = 0.0;
    for (std::size_t j = 0; j < hinges; ++j) {
        Hinge& h = hinge[b * hinges + j];
        const bool used = j < curve.slope.size();
        h.deflection[i] = used ? curve.deflection[j] : 0.0;
        h.slope_change[i] = used ? scale * (curve.slope[j] - slope) : 0.0;
        if (used) slope = curve.slope[j];
    }
}

}  // namespace birm3d
