#include "scene/body_overlap.hpp"

#include <cmath>

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::infinity;

namespace {

// A body that stands at `position`, turned about the vertical (rad).
Placement standing(const Vec3& position, double yaw = 0.0) {
    return {Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix(), position};
}

const Box box{{0.3, 0.0, 0.1}, {2.0, 0.5, 0.4}};
constexpr double found = 0.02;  // share to which a depth in the shape is found

}  // namespace

TEST("a corner of the box is the deepest in a half-space") {
    const Shape plane = HalfSpace{-Vec3::UnitX(), 0.0};
    CHECK_CLOSE(overlap_of_box(plane, standing({-2.1, 0.0, 0.0}), box), 0.2, 1e-9, "exact at a corner");
    CHECK(overlap_of_box(plane, standing({-2.3001, 0.0, 0.0}), box) == 0.0);
    const double yaw = 0.3, foremost = 2.3 * std::cos(yaw) + 0.5 * std::sin(yaw);
    CHECK_CLOSE(overlap_of_box(plane, standing({-foremost + 0.15, 0.0, 0.0}, yaw), box), 0.15, 1e-9,
                "exact at a corner");
}

TEST("a post beside the box reaches into its flat side, where no corner is near") {
    const Shape post = Post(0.16);
    for (const double depth : {0.003, 0.05, 0.15})
        CHECK_CLOSE(overlap_of_box(post, standing({-0.4, -0.5 - 0.16 + depth, 0.0}), box), depth,
                    found * depth, "depth of the flat side in the post");
    CHECK(overlap_of_box(post, standing({-0.4, -0.6601, 0.0}), box) == 0.0);
}

TEST("a thin post in the middle of the box counts by what it went through") {
    const Shape thin = Post(0.02);
    CHECK_CLOSE(overlap_of_box(thin, standing({-0.301, 0.0, -0.1}), box), 0.4 + 0.02, 0.06,
                "half the least edge and the radius; a descent ends near the middle");
}

TEST("a post that ends below the box does not overlap with it") {
    CHECK(overlap_of_box(Post(0.16, 0.5), standing({-0.3, 0.0, 0.81}), box) == 0.0);
    CHECK(overlap_of_box(Post(0.16, 0.5), standing({-0.3, 0.0, 0.75}), box) > 0.04);
}
