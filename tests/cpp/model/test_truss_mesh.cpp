#include "birm3d/model/truss_mesh.hpp"

#include <algorithm>
#include <stdexcept>

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

constexpr int columns = 13, rows = 10;  // 130 trusses: two full blocks and two trusses more
const TrussInput input = laboratory::front_face(laboratory::w2_curve(), columns, rows);

}  // namespace

TEST("trusses are cut into blocks, the last one padded with members of no stiffness") {
    const TrussMesh mesh(input);
    CHECK(mesh.count == 130);
    CHECK(mesh.blocks == 3);
    CHECK(mesh.hinges == 2);
    CHECK(mesh.hinge.size() == mesh.blocks * mesh.hinges);
    double stiffness = 0.0, first_slope = 0.0;
    for (std::size_t b = 0; b < mesh.blocks; ++b) {
        for (std::size_t i = 0; i < block_size; ++i) {
            const bool padding = b * block_size + i >= mesh.count;
            CHECK((mesh.block[b].k_unloading[i] == 0.0) == padding);
            CHECK((mesh.block[b].compliance[i] == 0.0) == padding);
            stiffness += mesh.block[b].k_unloading[i];
            first_slope += mesh.hinge[b * mesh.hinges].slope_change[i];
        }
    }
    CHECK_CLOSE(stiffness, 60e6, 1e-6, "rounding of 130 shares");
    CHECK_CLOSE(first_slope, 3e6, 1e-6, "rounding of 130 shares");
}

TEST("the order of the trusses is a permutation of the caller's") {
    const TrussMesh mesh(input);
    std::vector<std::size_t> order(mesh.input_index.begin(), mesh.input_index.end());
    CHECK(order.size() == mesh.count);
    for (std::size_t i = 0; i < mesh.count; ++i) {
        CHECK(mesh.node(i) == input.node[mesh.input_index[i]]);
        CHECK(mesh.anchor(i) == input.anchor[mesh.input_index[i]]);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i)
        CHECK(order[i] == i);
}

TEST("boxes and reach hold every node and anchor") {
    const TrussMesh mesh(input);
    double farthest = 0.0;
    for (std::size_t i = 0; i < mesh.count; ++i) {
        for (const auto& [point, box] : {std::pair{mesh.node(i), mesh.node_box[i / block_size]},
                                         std::pair{mesh.anchor(i), mesh.anchor_box[i / block_size]},
                                         std::pair{mesh.anchor(i), mesh.anchors}})
            CHECK(((point - box.center).cwiseAbs() - box.half).maxCoeff() <=
                  1e-15);  // rounding of the middle
        farthest = std::max({farthest, mesh.node(i).norm(), mesh.anchor(i).norm()});
    }
    CHECK_CLOSE(mesh.reach, farthest, 0.0, "exact");
}

TEST("neighbours in order are neighbours in space") {
    const TrussMesh mesh(laboratory::front_face(laboratory::w2_curve(), 64, 64));
    for (const Box& box : mesh.node_box)
        CHECK(box.half.norm() < 0.5);  // of a face 2.4 m by 1.6 m
}

TEST("what is no skin is refused") {
    const auto refused = [](auto change) {
        TrussInput bad = input;
        change(bad);
        CHECK_THROWS(TrussMesh(bad), std::invalid_argument);
    };
    refused([](TrussInput& bad) { bad = {}; });
    refused([](TrussInput& bad) { bad.anchor.pop_back(); });
    refused([](TrussInput& bad) { bad.anchor[7] = bad.node[7]; });
    refused([](TrussInput& bad) { bad.node[3].x() = std::nan(""); });
    refused([](TrussInput& bad) { bad.curve_of[5] = 1; });
    refused([](TrussInput& bad) { bad.scale[5] = -1.0; });
    refused([](TrussInput& bad) { bad.curve[0].k_unloading = 1.0; });
}

TEST("treads stand in blocks of their own behind the skin, which stays as it was") {
    TrussInput with = laboratory::front_face(laboratory::w2_curve(), columns, rows);
    const Wheel wheel{Vec3(1.5, 0.8, -0.6), 0.4};
    with.wheel_of.assign(130, -1);
    for (const double up : {-0.3, 0.1, 0.3}) {  // before the skin in the caller's order
        with.node.insert(with.node.begin(), Vec3(1.5 + up, 0.9, -0.6 + up));
        with.anchor.insert(with.anchor.begin(), Vec3(9.0, 0.5, -0.6));
        with.curve_of.insert(with.curve_of.begin(), 0);
        with.scale.insert(with.scale.begin(), 0.5);
        with.wheel_of.insert(with.wheel_of.begin(), 0);
    }
    const TrussMesh skin(input), mesh(with, {wheel});
    CHECK(mesh.count == 133 && mesh.skin == 130);
    CHECK(mesh.skin_blocks == 3 && mesh.blocks == 4 && mesh.tire_nodes.size() == 3);
    CHECK(mesh.nodes_in(0) == block_size && mesh.nodes_in(2) == 130 - 2 * block_size &&
          mesh.nodes_in(3) == 3);
    for (std::size_t b = 0; b < 3; ++b) {
        CHECK(mesh.block[b].node_y == skin.block[b].node_y && mesh.block[b].panel == skin.block[b].panel);
        CHECK(mesh.panels_of[b] == skin.panels_of[b]);
    }
    CHECK(mesh.panels_of[3] == 1U << panels);
    CHECK(mesh.anchors.half == skin.anchors.half);  // a tread's anchor is none of the rigid body
    for (std::size_t truss = 0; truss < mesh.count; ++truss) {
        CHECK(mesh.node(truss) == with.node[mesh.input_index[truss]]);
        CHECK(mesh.anchor(truss) == with.anchor[mesh.input_index[truss]]);
        CHECK((with.wheel_of[mesh.input_index[truss]] == 0) == (truss >= mesh.skin));
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 d = mesh.node(mesh.skin + i) - wheel.center;
        CHECK(mesh.tire_nodes[i].wheel == 0);
        CHECK_CLOSE(mesh.tire_nodes[i].tread_r, d.z() / 0.4, 1e-15, "rounding");
        CHECK_CLOSE(mesh.tire_nodes[i].tread_t, -d.x() / 0.4, 1e-15, "rounding");
        CHECK(mesh.block[3].k_unloading[i] == 0.5 * 60e6);
    }
    for (std::size_t i = 3; i < block_size; ++i)
        CHECK(mesh.block[3].k_unloading[i] == 0.0);
}

TEST("each wheel's tread has blocks of its own, padded by the skin's anchor next to it") {
    TrussInput with = laboratory::front_face(laboratory::w2_curve(), 2, 2);
    const std::vector<Wheel> wheels{{Vec3(1.5, 0.8, -0.6), 0.4}, {Vec3(-1.5, 0.8, -0.6), 0.4}};
    with.wheel_of.assign(with.node.size(), -1);
    for (int i = 0; i < 70; ++i) {  // of the first wheel five, in between
        const std::size_t w = i % 14 == 0 ? 0 : 1;
        with.node.push_back(wheels[w].center + Vec3(0.005 * i, 0.1, -0.2));
        with.anchor.push_back(wheels[w].center);
        with.curve_of.push_back(0);
        with.scale.push_back(1.0);
        with.wheel_of.push_back(static_cast<int>(w));
    }
    const TrussMesh mesh(with, wheels);
    CHECK(mesh.skin_blocks == 1 && mesh.blocks == 4);
    CHECK(mesh.nodes_in(1) == 5 && mesh.nodes_in(2) == block_size && mesh.nodes_in(3) == 1);
    for (std::size_t truss = 0; truss < mesh.count; ++truss) {
        const std::size_t source = mesh.input_index[truss];
        CHECK(mesh.node(truss) == with.node[source]);
        if (truss >= mesh.skin)
            CHECK(static_cast<int>(mesh.tire_nodes[truss - mesh.skin].wheel) == with.wheel_of[source]);
    }
    for (std::size_t b = 1; b < 4; ++b) {
        double nearest = 1e9;
        for (std::size_t truss = 0; truss < mesh.skin; ++truss)
            nearest = std::min(nearest, (mesh.anchor(truss) - mesh.node(mesh.first[b])).norm());
        for (std::size_t i = mesh.nodes_in(b); i < block_size; ++i) {
            const Vec3 anchor = anchor_of(mesh.block[b], i);
            CHECK((anchor - mesh.node(mesh.first[b])).norm() == nearest);
            CHECK(mesh.block[b].k_unloading[i] == 0.0 && mesh.block[b].length[i] > 0.0);
        }
    }
}

TEST("treads of wheels that are not there are refused") {
    TrussInput wrong = laboratory::front_face(laboratory::w2_curve(), 2, 2);
    wrong.wheel_of = {-1, -1, 1, -1};
    CHECK_THROWS(TrussMesh(wrong, {Wheel{Vec3::Zero(), 0.4}}), std::invalid_argument);
    wrong.wheel_of = {0, 0, 0, 0};  // no skin
    CHECK_THROWS(TrussMesh(wrong, {Wheel{Vec3::Zero(), 0.4}}), std::invalid_argument);
    wrong.wheel_of = {-1, -1};
    CHECK_THROWS(TrussMesh{wrong}, std::invalid_argument);
}

TEST("second trusses stand in blocks of their own behind the skin; those across are of a side") {
    TrussInput with = input;
    const int n = columns * rows;
    const auto is_across = [](int i) { return i < 35; };
    for (int i = 0; i < 70; ++i) {
        const auto of = static_cast<std::size_t>(i);
        with.node.push_back(input.node[of]);
        with.anchor.push_back(input.node[of] + (is_across(i) ? Vec3(0.0, 2.0, 0.0) : Vec3(-3.0, 0.0, 0.0)));
        with.curve_of.push_back(0);
        with.scale.push_back(input.scale[of]);
    }
    with.along_of.assign(with.node.size(), -1);
    for (int i = 0; i < 70; ++i)
        with.along_of[static_cast<std::size_t>(n + i)] = i;
    const TrussMesh mesh(with), bare(input);
    CHECK(mesh.skin == 130 && mesh.shell == 200 && mesh.count == 200);
    CHECK(mesh.skin_blocks == 3 && mesh.shell_blocks == 5 && mesh.blocks == 5);
    CHECK(mesh.tire_nodes.empty());
    for (std::size_t b = 0; b < mesh.blocks; ++b) {
        unsigned bits = 0;
        for (std::size_t i = 0; i < mesh.nodes_in(b); ++i) {
            const int of = with.along_of[mesh.input_index[mesh.first[b] + i]];
            const std::size_t panel = of < 0          ? static_cast<std::size_t>(bare.block[0].panel[0])
                                      : is_across(of) ? 2  // its inward direction is +s
                                                      : panels;
            CHECK(mesh.block[b].panel[i] == double(panel));
            bits |= 1U << panel;
        }
        CHECK(mesh.panels_of[b] == bits);
    }
    // A post is beyond the side once it has passed the far ends of the trusses across.
    CHECK(mesh.panel[2].any && !bare.panel[2].any);
    CHECK_CLOSE(mesh.panel[2].anchors.center.y() - mesh.panel[2].box.center.y(), 2.0, 1e-12, "rounding");
    CHECK(mesh.anchors.half == bare.anchors.half && mesh.anchors.center == bare.anchors.center);
    CHECK(mesh.reach == bare.reach);
    for (const int wrong : {-2, n, 1000}) {
        with.along_of.back() = wrong;
        CHECK_THROWS(TrussMesh(with), std::invalid_argument);
    }
}

TEST("copies share their columns; a mesh that is seen from elsewhere has new places and shares the rest") {
    const TrussMesh mesh(input), copy = mesh, moved = mesh.moved(Vec3(0.5, -0.25, 0.125));
    CHECK(copy.block.data() == mesh.block.data());
    CHECK(moved.block.data() != mesh.block.data());
    CHECK(moved.first.data() == mesh.first.data());
    CHECK(moved.hinge.begin() == mesh.hinge.begin());
    for (std::size_t i = 0; i < mesh.count; ++i) {
        CHECK(mesh.node(i) == input.node[mesh.input_index[i]]);
        CHECK_CLOSE((moved.node(i) + Vec3(0.5, -0.25, 0.125) - mesh.node(i)).norm(), 0.0, 1e-15, "rounding");
    }
}

TEST("heights above the lower edge are those of a column of the panel") {
    // The left half of a front begins at z = 0, the right half at 0.8.
    std::vector<Vec3> nodes;
    for (int y = -5; y <= 5; ++y)
        for (int z = y < 0 ? 8 : 0; z <= 12; ++z)
            nodes.emplace_back(1.0, 0.3 * y, 0.1 * z);
    const std::vector<double> heights = heights_above_edge(nodes, -Vec3::UnitX());
    for (std::size_t k = 0; k < nodes.size(); ++k)
        CHECK_CLOSE(heights[k], nodes[k].z() - (nodes[k].y() < -0.1 ? 0.8 : 0.0), 1e-15, "rounding");
    for (const double height : heights_above_edge(nodes, -Vec3::UnitZ()))
        CHECK(height == 0.0);
    // Of a side, columns stand along x: there all nodes are in one.
    const std::vector<double> of_side = heights_above_edge(nodes, Vec3::UnitY());
    CHECK_CLOSE(*std::max_element(of_side.begin(), of_side.end()), 1.2, 1e-15, "rounding");
}
