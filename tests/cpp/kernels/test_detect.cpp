#include "birm3d/kernels/detect.hpp"

#include "check.hpp"

using namespace birm3d;

TEST("the gap is the signed distance along the outward normal") {
    const Vec3 n = Vec3(1.0, -2.0, 2.0) / 3.0;
    const HalfSpace face{n, 0.7};
    Lanes x, y, z;
    for (std::size_t i = 0; i < lanes; ++i) {
        // 0.1 i before the plane, and off to the side along two directions within it.
        const Vec3 p = (0.7 + 0.1 * static_cast<double>(i) - 3.0) * n + 0.3 * Vec3(2.0, 1.0, 0.0) -
                       5.0 * Vec3(0.0, 1.0, 1.0);
        x[i] = p.x(), y[i] = p.y(), z[i] = p.z();
    }
    const Lanes gap = gaps(face, x, y, z);
    for (std::size_t i = 0; i < lanes; ++i)
        CHECK_CLOSE(gap[i], 0.1 * static_cast<double>(i) - 3.0, 1e-14, "rounding");
}

TEST("a plane seen from moved and turned axes is the same plane") {
    const HalfSpace face{Vec3(-3.0, 0.0, 4.0) / 5.0, 1.3};
    const Vec3 place(2.0, -1.0, 0.5);
    const Mat3 R = Quat(Eigen::AngleAxisd(0.8, Vec3(1.0, 1.0, -1.0).normalized())).toRotationMatrix();
    const HalfSpace seen = face.seen_from(place, R);
    for (const Vec3& p : {Vec3(0.0, 0.0, 0.0), Vec3(1.0, 2.0, 3.0), Vec3(-4.0, 0.0, 1.0)})
        CHECK_CLOSE(seen.gap(p), face.gap(place + R * p), 1e-14, "rounding");
}
