#include <algorithm>
#include <cmath>
#include <utility>

#include "birm3d/model/truss_mesh.hpp"
#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

constexpr int columns = 13, rows = 10;  // two full blocks and two trusses more, and the treads'
const Vec3 origin(0.31, -0.07, 0.23);

// A front and a left side, and the treads of two wheels.
TrussInput skin_and_treads(const std::vector<Wheel>& wheels) {
    TrussInput input = laboratory::front_face(laboratory::w2_curve(), columns, rows);
    const auto add = [&](const Vec3& node, const Vec3& anchor, int wheel) {
        input.node.push_back(node);
        input.anchor.push_back(anchor);
        input.curve_of.push_back(0);
        input.scale.push_back(0.3);
        input.wheel_of.push_back(wheel);
    };
    input.wheel_of.assign(input.node.size(), -1);
    for (int i = 0; i < 20; ++i)
        add({-1.3 + 0.17 * i, 1.2, 0.04 * i}, {-1.2 + 0.15 * i, 0.3, 0.03 * i}, -1);
    for (int i = 0; i < 5; ++i)
        for (int w = 0; w < 2; ++w)
            add(wheels[static_cast<std::size_t>(w)].center + Vec3(0.1 * i - 0.2, 0.13, -0.3),
                wheels[static_cast<std::size_t>(w)].center, w);
    return input;
}

std::vector<Wheel> two_wheels(const Vec3& observer) {
    return {{Vec3(1.5, 0.8, -0.6) - observer, 0.4}, {Vec3(-1.5, 0.8, -0.6) - observer, 0.4}};
}

// What the constructor makes of the moved input.
TrussMesh made_anew() {
    TrussInput input = skin_and_treads(two_wheels(Vec3::Zero()));
    for (std::size_t i = 0; i < input.node.size(); ++i)
        input.node[i] -= origin, input.anchor[i] -= origin;
    return TrussMesh(input, two_wheels(origin));
}

TrussMesh mesh_here() {
    return TrussMesh(skin_and_treads(two_wheels(Vec3::Zero())), two_wheels(Vec3::Zero()));
}

void check_same(const Box& a, const Box& b) {
    CHECK_CLOSE((a.center - b.center).norm() + (a.half - b.half).norm(), 0.0, 1e-14, "rounding");
}

double apart(const BlockColumn& a, const BlockColumn& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < block_size; ++i)
        most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

}  // namespace

TEST("moved trusses are those that the constructor makes of the moved input") {
    const TrussMesh moved = mesh_here().moved(origin), anew = made_anew();
    CHECK(moved.count == anew.count && moved.skin == anew.skin && moved.blocks == anew.blocks);
    CHECK(std::equal(moved.first.begin(), moved.first.end(), anew.first.begin(), anew.first.end()));
    for (std::size_t truss = 0; truss < anew.count; ++truss) {
        CHECK(moved.input_index[truss] == anew.input_index[truss]);
        CHECK_CLOSE((moved.node(truss) - anew.node(truss)).norm(), 0.0, 1e-14, "rounding");
        CHECK_CLOSE((moved.anchor(truss) - anew.anchor(truss)).norm(), 0.0, 1e-14, "rounding");
    }
    for (std::size_t b = 0; b < anew.blocks; ++b) {
        // Padding too: it must reach nothing.
        const TrussBlock &one = moved.block[b], &other = anew.block[b];
        for (BlockColumn TrussBlock::* column :
             {&TrussBlock::node_x, &TrussBlock::node_y, &TrussBlock::node_z, &TrussBlock::anchor_x,
              &TrussBlock::anchor_y, &TrussBlock::anchor_z, &TrussBlock::length})
            CHECK_CLOSE(apart(one.*column, other.*column), 0.0, 1e-14, "rounding");
        CHECK(one.k_unloading == other.k_unloading && one.compliance == other.compliance);
        CHECK(one.panel == other.panel && moved.panels_of[b] == anew.panels_of[b]);
        CHECK(moved.pushable[b] == anew.pushable[b]);
    }
}

TEST("boxes, panels, reach and moments of stiffness move along") {
    const TrussMesh here = mesh_here(), moved = here.moved(origin), anew = made_anew();
    CHECK_CLOSE(moved.reach, anew.reach, 1e-14, "rounding");
    CHECK(std::abs(moved.reach - here.reach) > 0.01);  // else nothing was asked
    check_same(moved.anchors, anew.anchors);
    for (std::size_t b = 0; b < anew.blocks; ++b) {
        check_same(moved.node_box[b], anew.node_box[b]);
        check_same(moved.anchor_box[b], anew.anchor_box[b]);
        CHECK(moved.moments[b].total == anew.moments[b].total);
        CHECK_CLOSE((moved.moments[b].second - anew.moments[b].second).norm() / 60e6, 0.0, 1e-14, "rounding");
    }
    int with_nodes = 0;
    for (std::size_t p = 0; p < panels; ++p) {
        CHECK(moved.panel[p].any == anew.panel[p].any && moved.panel[p].inward == anew.panel[p].inward);
        if (!anew.panel[p].any) continue;
        ++with_nodes;
        check_same(moved.panel[p].box, anew.panel[p].box);
        check_same(moved.panel[p].anchors, anew.panel[p].anchors);
    }
    CHECK(with_nodes == 2);
}

TEST("what does not change is shared, and treads turn as they did") {
    const TrussMesh here = mesh_here(), moved = here.moved(origin), anew = made_anew();
    CHECK(&*moved.hinge.begin() == &*here.hinge.begin());
    CHECK(&*moved.input_index.begin() == &*here.input_index.begin());
    CHECK(moved.tire_nodes.size() == 10);
    for (std::size_t i = 0; i < moved.tire_nodes.size(); ++i) {
        CHECK(moved.tire_nodes[i].wheel == anew.tire_nodes[i].wheel);
        CHECK_CLOSE(moved.tire_nodes[i].tread_r, anew.tire_nodes[i].tread_r, 1e-14, "rounding");
        CHECK_CLOSE(moved.tire_nodes[i].tread_t, anew.tire_nodes[i].tread_t, 1e-14, "rounding");
    }
}

TEST("moved by nothing, and there and back") {
    const TrussMesh here = mesh_here(), same = here.moved(Vec3::Zero()),
                    back = here.moved(origin).moved(-origin);
    for (std::size_t b = 0; b < here.blocks; ++b) {
        CHECK(same.block[b].node_x == here.block[b].node_x && same.block[b].length == here.block[b].length);
        CHECK_CLOSE(apart(back.block[b].node_z, here.block[b].node_z), 0.0, 1e-15, "rounding");
    }
    CHECK(same.reach == here.reach);
    CHECK_CLOSE(back.reach, here.reach, 1e-14, "rounding");
}
