#include "birm3d/geometry/cylinder.hpp"

#include "check.hpp"

using namespace birm3d;

TEST("distance and normal of a slanted cylinder") {
    const Vec3 axis = Vec3(1.0, 2.0, 2.0) / 3.0, across = Vec3(2.0, 1.0, -2.0) / 3.0;
    const Cylinder cylinder{Vec3(0.3, -0.2, 0.1), axis, 0.25};
    for (const double distance : {0.01, 0.25, 3.0}) {
        const Vec3 p = cylinder.point + 7.0 * axis + distance * across;
        CHECK_CLOSE(cylinder.gap(p), distance - 0.25, 1e-14, "rounding of 7 m");
        CHECK_CLOSE((cylinder.normal_at(p) - across).norm(), 0.0, 1e-12, "rounding over 0.01 m");
    }
    const Vec3 on_axis = cylinder.normal_at(cylinder.point);
    CHECK_CLOSE(on_axis.norm(), 1.0, 1e-14, "some direction across the axis");
    CHECK_CLOSE(on_axis.dot(axis), 0.0, 1e-14, "the same");
}

TEST("a cylinder seen from moved and turned axes is the same cylinder") {
    const Cylinder cylinder{Vec3(1.0, 2.0, 0.0), Vec3::UnitZ(), 0.4};
    const Vec3 place(2.0, -1.0, 0.5);
    const Mat3 R = Quat(Eigen::AngleAxisd(0.8, Vec3(1.0, 1.0, -1.0).normalized())).toRotationMatrix();
    const Cylinder seen = cylinder.seen_from(place, R);
    for (const Vec3& p : {Vec3(0.0, 0.0, 0.0), Vec3(1.0, 2.0, 3.0), Vec3(-4.0, 0.0, 1.0)}) {
        CHECK_CLOSE(seen.gap(p), cylinder.gap(place + R * p), 1e-14, "rounding");
        CHECK_CLOSE((R * seen.normal_at(p) - cylinder.normal_at(place + R * p)).norm(), 0.0, 1e-14,
                    "rounding");
    }
}

TEST("no point of a box out of reach is within the margin") {
    const Cylinder cylinder{Vec3::Zero(), Vec3::UnitZ(), 0.5};
    const Box box{Vec3(2.0, 0.0, 4.0), Vec3(0.4, 0.3, 1.0)};
    double nearest = 1e9;
    for (const double x : {-1.0, 0.0, 1.0})
        for (const double y : {-1.0, 0.0, 1.0})
            nearest =
                std::min(nearest, cylinder.gap(box.center + Vec3(x * box.half.x(), y * box.half.y(), 0.0)));
    CHECK(cylinder.within_reach(box, nearest + 1e-9));
    CHECK(!cylinder.within_reach(Box{Vec3(9.0, 0.0, 4.0), box.half}, 1.0));
}
