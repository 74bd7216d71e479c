#include "birm3d/geometry/shape.hpp"

#include "birm3d/base/error.hpp"
#include "check.hpp"
#include "geometry/shape_laws.hpp"

using namespace birm3d;

namespace {

void check_nearest(const Post& post, const Vec3& p, double gap, const Vec3& normal) {
    const Nearest n = nearest(post, p);
    CHECK_CLOSE(n.gap, gap, 1e-15, "rounding");
    CHECK_CLOSE((n.normal - normal).norm(), 0.0, 1e-15, "rounding");
}

}  // namespace

TEST("side, top disc and rim of a post") {
    const Post post(0.25, 1.0);
    check_nearest(post, {-2.0, 0.0, 0.5}, 1.75, -Vec3::UnitX());
    check_nearest(post, {0.0, 0.2, 0.5}, -0.05, Vec3::UnitY());
    check_nearest(post, {0.03, 0.1, 1.5}, 0.5, Vec3::UnitZ());
    check_nearest(post, {0.03, 0.04, 0.9}, -0.1, Vec3::UnitZ());
    check_nearest(post, {0.25 + 0.3, 0.0, 1.4}, 0.5, {0.6, 0.0, 0.8});
}

TEST("on the axis, and where the faces meet, the normal is that of a face") {
    const Post post(0.25, 1.0);
    check_nearest(post, {0.0, 0.0, 0.2}, -0.25, Vec3::UnitX());
    check_nearest(post, {1e-200, 0.0, 0.2}, -0.25, Vec3::UnitX());
    check_nearest(post, {0.25, 0.0, 1.0}, 0.0, Vec3::UnitZ());
    const Nearest rim = nearest(post, {0.25 + 1e-14, 0.0, 1.0 + 1e-15});
    CHECK_CLOSE((rim.normal - Vec3::UnitX()).norm(), 0.0, 1e-15, "nearer than edge_radius: a face's own");
}

TEST("a post goes on endlessly below the ground, and upwards if it has no height") {
    check_nearest(Post(0.25, 1.0), {0.2, 0.0, -50.0}, -0.05, Vec3::UnitX());
    check_nearest(Post(0.25), {0.0, 0.5, 1e6}, 0.25, Vec3::UnitY());
    CHECK(std::isinf(thickness(HalfSpace{})));
    CHECK_CLOSE(thickness(Post(0.25, 1.0)), 0.5, 0.0, "the diameter");
}

TEST("the gap of a post is a distance and its normal the gradient") {
    const Post post(0.3, 0.9);
    laboratory::check_distance_laws([&](const Vec3& p) { return nearest(post, p); }, {-1.0, -1.0, -0.5},
                                    {1.0, 1.0, 2.0}, 1.0, 20000, 1);
}

TEST("posts that are none are refused") {
    CHECK_THROWS(Post(0.0, 1.0), InvalidArgument);
    CHECK_THROWS(Post(-0.1, 1.0), InvalidArgument);
    CHECK_THROWS(Post(std::nan(""), 1.0), InvalidArgument);
    CHECK_THROWS(Post(0.1, 0.0), InvalidArgument);
    CHECK_THROWS(Post(0.1, std::nan("")), InvalidArgument);
}
