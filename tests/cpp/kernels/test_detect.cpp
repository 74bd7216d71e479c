#include "kernels/detect.hpp"

#include <random>

#include "check.hpp"

using namespace birm3d;

TEST("the box around a block of nodes holds them all and no more") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-3.0, 2.0);
    BlockColumn x, y, z;
    for (BlockColumn* column : {&x, &y, &z})
        for (double& value : *column)
            value = uniform(random);
    const Box box = box_around(x, y, z);
    const Box known = Box::around(block_size, [&](std::size_t i) { return Vec3(x[i], y[i], z[i]); });
    CHECK(box.center == known.center);
    CHECK(box.half == known.half);
}

TEST("a plane seen from moved and turned axes is the same plane") {
    const HalfSpace face{Vec3(-3.0, 0.0, 4.0) / 5.0, 1.3};
    const Vec3 place(2.0, -1.0, 0.5);
    const Mat3 R = Quat(Eigen::AngleAxisd(0.8, Vec3(1.0, 1.0, -1.0).normalized())).toRotationMatrix();
    const HalfSpace seen = face.in_axes(place, R);
    for (const Vec3& p : {Vec3(0.0, 0.0, 0.0), Vec3(1.0, 2.0, 3.0), Vec3(-4.0, 0.0, 1.0)})
        CHECK_CLOSE(seen.gap(p), face.gap(place + R * p), 1e-14, "rounding");
}
