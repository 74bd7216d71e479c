#include "birm3d/model/truss_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <tuple>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

bool is_of_skin(const TrussInput& input, std::size_t i) {
    return input.wheel_of.empty() || input.wheel_of[i] == -1;
}

void require_valid(const TrussInput& input, std::size_t wheels) {
    const std::size_t n = input.node.size();
    require_not_negative("rate_sensitivity", input.rate_sensitivity);
    require_not_negative("indentation_length", input.indentation_length);
    if (n == 0) refuse("nodes", "at least 1", 0.0);
    const auto same_size = [n](const char* name, std::size_t size) {
        if (size != n)
            refuse(name, std::to_string(n) + " entries, one for each node", static_cast<double>(size));
    };
    same_size("anchors", input.anchor.size());
    same_size("curve_of", input.curve_of.size());
    same_size("scale", input.scale.size());
    if (!input.wheel_of.empty()) same_size("wheel_of", input.wheel_of.size());
    if (!input.along_of.empty()) same_size("along_of", input.along_of.size());
    for (std::size_t i = 0; i < input.wheel_of.size(); ++i)
        if (input.wheel_of[i] < -1 || input.wheel_of[i] >= static_cast<int>(wheels))
            refuse("wheel_of[" + std::to_string(i) + "]",
                   "-1 or below " + std::to_string(wheels) + ", the number of wheels",
                   static_cast<double>(input.wheel_of[i]));

    for (std::size_t i = 0; i < input.along_of.size(); ++i) {
        const int skin_node = input.along_of[i];
        if (skin_node == -1) continue;
        const bool is_skin = skin_node >= 0 && skin_node < static_cast<int>(n) && is_of_skin(input, i) &&
                             is_of_skin(input, static_cast<std::size_t>(skin_node)) &&
                             input.along_of[static_cast<std::size_t>(skin_node)] == -1;
        if (!is_skin)
            refuse("along_of[" + std::to_string(i) + "]", "-1 or the number of a node of the skin",
                   static_cast<double>(skin_node));
    }

    for (std::size_t c = 0; c < input.curve.size(); ++c)
        require_valid(input.curve[c], input.curve.size() == 1 ? "" : "curve[" + std::to_string(c) + "] ");
    for (std::size_t i = 0; i < n; ++i) {
        const auto at = [i](const char* name) { return name + ("[" + std::to_string(i) + "]"); };
        if (!input.node[i].allFinite()) refuse(at("nodes"), "finite", "a coordinate that is not");
        if (!input.anchor[i].allFinite()) refuse(at("anchors"), "finite", "a coordinate that is not");
        const double length = (input.node[i] - input.anchor[i]).norm();
        if (!(length >= tolerance::truss_length))
            refuse(at("truss length"), ">= " + to_text(tolerance::truss_length) + " m", length);
        if (input.curve_of[i] >= input.curve.size())
            refuse(at("curve_of"), "< " + std::to_string(input.curve.size()),
                   static_cast<double>(input.curve_of[i]));
        if (!(input.scale[i] >= 0.0 && std::isfinite(input.scale[i])))
            require_not_negative(at("scale").c_str(), input.scale[i]);
    }
}

// Position in the space in which trusses are sorted: the node, and the direction of the truss as half a metre. The
// direction separates the two sides of a corner of the vehicle.
using Site = std::array<double, 6>;

Site site_of(const Vec3& node, const Vec3& anchor) {
    constexpr double direction_length = 0.5;
    const Vec3 points = direction_length * (anchor - node).normalized();
    return {node.x(), node.y(), node.z(), points.x(), points.y(), points.z()};
}

using Places = std::span<std::size_t>;

std::size_t widest_axis(const std::vector<Site>& site, Places some) {
    std::size_t widest = 0;
    double width = -1.0;
    for (std::size_t axis = 0; axis < std::tuple_size_v<Site>; ++axis) {
        const auto [low, high] =
            std::minmax_element(some.begin(), some.end(),
                                [&](std::size_t a, std::size_t b) { return site[a][axis] < site[b][axis]; });
        const double wide = site[*high][axis] - site[*low][axis];
        if (wide > width) width = wide, widest = axis;
    }
    return widest;
}

// Cuts the trusses in two across their widest extent until each part is a block. All blocks are full but the last.
void cut_into_blocks(const std::vector<Site>& site, Places some) {
    if (some.size() <= block_size) {
        std::sort(some.begin(), some.end());
        return;
    }
    const std::size_t axis = widest_axis(site, some);
    const std::size_t parts = (some.size() + block_size - 1) / block_size, first = parts / 2 * block_size;
    std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(first), some.end(),
                     [&](std::size_t a, std::size_t b) {
                         return std::tie(site[a][axis], site[a], a) < std::tie(site[b][axis], site[b], b);
                     });
    cut_into_blocks(site, some.first(first));
    cut_into_blocks(site, some.subspan(first));
}

std::vector<Site> sites_of(const TrussInput& input) {
    std::vector<Site> site;
    site.reserve(input.node.size());
    for (std::size_t i = 0; i < input.node.size(); ++i)
        site.push_back(site_of(input.node[i], input.anchor[i]));
    return site;
}

// The skin's trusses, the second ones of its nodes, then each wheel's.
std::vector<std::vector<std::size_t>> parts_of(const TrussInput& input, std::size_t wheels) {
    std::vector<std::vector<std::size_t>> part(2 + wheels);
    for (std::size_t i = 0; i < input.node.size(); ++i) {
        const bool second = !input.along_of.empty() && input.along_of[i] >= 0;
        const int wheel = input.wheel_of.empty() ? -1 : input.wheel_of[i];
        part[second ? 1 : wheel < 0 ? 0 : static_cast<std::size_t>(2 + wheel)].push_back(i);
    }
    return part;
}

Box box_around(const BlockColumn& x, const BlockColumn& y, const BlockColumn& z) {
    return Box::around(block_size, [&](std::size_t i) { return Vec3(x[i], y[i], z[i]); });
}

}  // namespace

TrussMesh::TrussMesh(const TrussInput& input, const std::vector<Wheel>& wheels) {
    require_valid(input, wheels.size());
    rate_sensitivity = input.rate_sensitivity;
    indentation_length = input.indentation_length;
    count = input.node.size();
    for (const TrussCurve& curve : input.curve)
        hinges = std::max(hinges, curve.slope.size()), recovers = recovers || has_recovery(curve.recovery);

    const std::vector<Site> site = sites_of(input);
    std::vector<std::vector<std::size_t>> parts = parts_of(input, wheels.size());
    if (parts[0].empty()) refuse("nodes of the skin", "at least 1", 0.0);
    for (std::size_t p = 0; p < parts.size(); ++p) {
        std::vector<std::size_t>& part = parts[p];
        for (std::size_t i = 0; i < part.size(); i += block_size)
            first.fill().push_back(input_index.size() + i);
        cut_into_blocks(site, part);  // neighbours together
        input_index.fill().insert(input_index.end(), part.begin(), part.end());
        if (p == 0) skin = input_index.size(), skin_blocks = first.size();
        if (p == 1) shell = input_index.size(), shell_blocks = first.size();
    }
    blocks = first.size();
    first.fill().push_back(count);

    anchors = Box::around(skin, [&](std::size_t i) { return input.anchor[input_index[i]]; });
    block.fill().resize(blocks);
    hinge.fill().resize(blocks * hinges);
    if (std::any_of(input.curve.begin(), input.curve.end(),
                    [](const TrussCurve& curve) { return curve.friction_share != 1.0; }))
        friction_share.fill().resize(blocks);
    for (std::size_t b = 0; b < blocks; ++b)
        fill_block(input, b);
    find_springback(input);
    find_panels(input);
    find_tread(input, wheels);
}

void TrussMesh::find_tread(const TrussInput& input, const std::vector<Wheel>& wheels) {
    for (std::size_t truss = shell; truss < count; ++truss) {
        const std::size_t source = input_index[truss];
        const auto w = static_cast<std::size_t>(input.wheel_of[source]);
        const Vec3 d = input.node[source] - wheels[w].center;
        tire_nodes.fill().push_back({d.z() / wheels[w].radius, -d.x() / wheels[w].radius, w});
    }
}

// A separate sum for each entry, so that the sums stay in registers.
StiffnessMoments stiffness_of(const TrussBlock& trusses) {
    double k = 0.0, xx = 0.0, xy = 0.0, xz = 0.0, yx = 0.0, yy = 0.0, yz = 0.0, zx = 0.0, zy = 0.0, zz = 0.0;
    for (std::size_t i = 0; i < block_size; ++i) {
        const double x = trusses.node_x[i], y = trusses.node_y[i], z = trusses.node_z[i];
        const double kx = trusses.k_unloading[i] * x, ky = trusses.k_unloading[i] * y,
                     kz = trusses.k_unloading[i] * z;
        k += trusses.k_unloading[i];
        xx += kx * x, xy += kx * y, xz += kx * z;
        yx += ky * x, yy += ky * y, yz += ky * z;
        zx += kz * x, zy += kz * y, zz += kz * z;
    }
    StiffnessMoments sum;
    sum.total = k;
    sum.second << xx, xy, xz, yx, yy, yz, zx, zy, zz;
    return sum;
}

void TrussMesh::fill_block(const TrussInput& input, std::size_t b) {
    const std::size_t nodes = nodes_in(b);
    for (std::size_t i = 0; i < nodes; ++i)
        fill_slot(input, input_index[first[b] + i], b, i);
    if (nodes < block_size) pad(input, b);
    const BlockColumn& k = block[b].k_unloading;
    pushable.fill().push_back(
        static_cast<double>(std::count_if(k.begin(), k.end(), [](double each) { return each > 0.0; })));
    moments.fill().push_back(stiffness_of(block[b]));
    node_box.fill().push_back(box_around(block[b].node_x, block[b].node_y, block[b].node_z));
    anchor_box.fill().push_back(box_around(block[b].anchor_x, block[b].anchor_y, block[b].anchor_z));
}

// Padding nodes are at the skin anchor nearest to the block: nothing touches them before the rigid body.
void TrussMesh::pad(const TrussInput& input, std::size_t b) {
    const Vec3 next_to = input.node[input_index[first[b]]];
    const auto by_distance = [&](std::size_t i, std::size_t j) {
        return (input.anchor[i] - next_to).squaredNorm() < (input.anchor[j] - next_to).squaredNorm();
    };
    const auto begin = input_index.begin(), end = begin + static_cast<std::ptrdiff_t>(skin);
    const std::size_t place = *std::min_element(begin, end, by_distance);
    constexpr double beside = 1e-3;
    const Vec3& anchor = input.anchor[place];
    for (std::size_t i = nodes_in(b); i < block_size; ++i)
        place_slot(Vec3(anchor + beside * (input.node[place] - anchor)), anchor, b, i);
}

void TrussMesh::place_slot(const Vec3& node, const Vec3& anchor, std::size_t b, std::size_t i) {
    reach = std::max({reach, node.norm(), b < skin_blocks ? anchor.norm() : 0.0});
    TrussBlock& to = block.fill()[b];
    to.node_x[i] = node.x(), to.node_y[i] = node.y(), to.node_z[i] = node.z();
    to.anchor_x[i] = anchor.x(), to.anchor_y[i] = anchor.y(), to.anchor_z[i] = anchor.z();
    to.length[i] = (node - anchor).norm();
}

void TrussMesh::fill_slot(const TrussInput& input, std::size_t source, std::size_t b, std::size_t i) {
    place_slot(input.node[source], input.anchor[source], b, i);
    const double scale = input.scale[source];
    const TrussCurve& curve = input.curve[input.curve_of[source]];
    TrussBlock& to = block.fill()[b];
    to.k_unloading[i] = scale * curve.k_unloading;
    to.compliance[i] = to.k_unloading[i] > 0.0 ? 1.0 / to.k_unloading[i] : 0.0;
    to.recovery[i] = curve.recovery;
    if (!friction_share.empty()) friction_share.fill()[b][i] = curve.friction_share;
    double slope = 0.0;
    for (std::size_t j = 0; j < hinges; ++j) {
        Hinge& h = hinge.fill()[b * hinges + j];
        const bool used = j < curve.slope.size();
        h.deflection[i] = used ? curve.deflection[j] : 0.0;
        h.slope_change[i] = used ? scale * (curve.slope[j] - slope) : 0.0;
        if (used) slope = curve.slope[j];
    }
}

}  // namespace birm3d
