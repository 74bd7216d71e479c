#include "birm3d/geometry/shape.hpp"

#include "check.hpp"
#include "geometry/meshes.hpp"
#include "geometry/random_points.hpp"

using namespace birm3d;

namespace {

const std::vector<Eigen::Vector2d> wall = {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.8}, {0.0, 0.8}};

std::vector<Shape> shapes() {
    return {HalfSpace{Vec3(-0.6, 0.0, 0.8), 0.3},
            Post(0.2, 0.9),
            Prism::box(0.4, 2.0, 0.8),
            Prism::box(0.4, infinity, infinity),
            Prism::symmetric({{0.3, 0.0}, {0.1, 0.5}, {0.1, 0.8}}, 3.0, 0.2),
            laboratory::extruded(wall, {0.2, 0.4}, -1.0, 1.0, 2).mesh()};
}

}  // namespace

TEST("a shape stands for the shape it holds") {
    const Vec3 p(-0.5, 0.1, 0.05);
    const double gap[] = {0.04, std::sqrt(0.26) - 0.2, 0.5, 0.5, 0.0, 0.5};
    for (const std::size_t i : {0U, 1U, 2U, 3U, 5U})
        CHECK_CLOSE(nearest(shapes()[i], p).gap, gap[i], 1e-14, "rounding");
    CHECK_CLOSE(nearest(shapes()[4], {-0.5, 0.1, -0.1}).gap, 0.2, 1e-14, "beside its vertical foot");
    const double thick[] = {infinity, 0.4, 0.4, 0.4, 0.2, 0.4};
    for (std::size_t i = 1; i < 6; ++i)
        CHECK_CLOSE(thickness(shapes()[i]), thick[i], 1e-14, "rounding");
    CHECK(std::isinf(thickness(shapes()[0])));
}

TEST("points inside lie within the bounds") {
    laboratory::Random random(8);
    for (const Shape& shape : shapes()) {
        const Box box = bounds(shape);
        CHECK(box.center.allFinite());
        CHECK((box.half.array() > 0.0).all());
        int inside = 0;
        for (int i = 0; i < 5000; ++i) {
            const Vec3 p = random.point({-1.0, -2.0, -1.0}, {1.0, 2.0, 1.5});
            if (nearest(shape, p).gap >= 0.0) continue;
            ++inside;
            CHECK(((p - box.center).cwiseAbs().array() <= box.half.array()).all());
        }
        CHECK(inside > 40);
    }
    CHECK_CLOSE(bounds(Post(0.2, 0.9)).half.x(), 0.2, 0.0, "exact");
    CHECK(std::isinf(bounds(Post(0.2, 0.9)).half.z()));
}

TEST("placements: there and back, one after the other, planes") {
    laboratory::Random random(12);
    for (int i = 0; i < 100; ++i) {
        const Placement a = random.placement(5.0), b = random.placement(5.0);
        const Vec3 p = random.point(Vec3::Constant(-3.0), Vec3::Constant(3.0));
        CHECK_CLOSE((a.from_own(a.to_own(p)) - p).norm(), 0.0, 1e-14, "rounding of 5 m");
        CHECK_CLOSE((a.inverse().to_own(p) - a.from_own(p)).norm(), 0.0, 1e-14, "rounding of 5 m");
        CHECK_CLOSE((a.after(b).to_own(p) - a.to_own(b.to_own(p))).norm(), 0.0, 2e-14, "rounding of 10 m");
        CHECK_CLOSE((a.direction_from_own(a.direction_to_own(p)) - p).norm(), 0.0, 1e-14, "rounding");
        const HalfSpace plane{random.direction(), 0.7};
        CHECK_CLOSE(a.plane_from_own(plane).gap(p), plane.gap(a.to_own(p)), 1e-14, "rounding of 5 m");
    }
}
