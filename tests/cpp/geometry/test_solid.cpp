#include "birm3d/geometry/solid.hpp"

#include <cmath>

#include "check.hpp"

using namespace birm3d;

namespace {

// A box with one corner at the origin, moved by `place` and turned by `turn`.
Hexahedron box(const Vec3& size, const Quat& turn = Quat::Identity(), const Vec3& place = Vec3::Zero()) {
    Hexahedron h;
    const int corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                               {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 share(corners[i][0], corners[i][1], corners[i][2]);
        h[i] = place + turn * share.cwiseProduct(size);
    }
    return h;
}

bool inside(const Tetrahedron& t, const Vec3& p) {
    for (std::size_t i = 0; i < 4; ++i) {
        Tetrahedron other = t;
        other[i] = p;
        if (signed_volume(other) < 0.0) return false;
    }
    return true;
}

}  // namespace

TEST("a corner tetrahedron has the integrals of the text book") {
    const double a = 1.7;
    const Tetrahedron t{Vec3(0, 0, 0), Vec3(a, 0, 0), Vec3(0, a, 0), Vec3(0, 0, a)};
    CHECK_CLOSE(signed_volume(t), a * a * a / 6.0, 1e-15, "rounding");
    CHECK_CLOSE((centroid(t) - Vec3::Constant(a / 4.0)).norm(), 0.0, 1e-15, "rounding");
    // Second moments about the corner: int x^2 = a^5/60, int x y = a^5/120; moved to the mass centre a/4.
    const Mat3 inertia = central_inertia(t);
    const double a5 = std::pow(a, 5);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            CHECK_CLOSE(inertia(i, j), i == j ? a5 / 80.0 : a5 / 480.0, 1e-15, "rounding");
}

TEST("the order of the vertices gives the sign") {
    const Tetrahedron t{Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
    CHECK_CLOSE(signed_volume(t), -1.0 / 6.0, 1e-16, "rounding");
}

TEST("the six tetrahedra of a turned box have its volume and its inertia") {
    const Vec3 size(2.0, 0.7, 1.3);
    const Quat turn(Eigen::AngleAxisd(0.9, Vec3(1, 2, -1).normalized()));
    const Vec3 place(3.0, -1.0, 0.5);
    const Vec3 center = place + turn * (0.5 * size);
    double volume = 0.0;
    Mat3 inertia = Mat3::Zero();
    for (const Tetrahedron& part : split(box(size, turn, place))) {
        const double share = signed_volume(part);
        const Vec3 arm = centroid(part) - center;
        CHECK(share > 0.0);
        volume += share;
        inertia +=
            central_inertia(part) + share * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
    }
    CHECK_CLOSE(volume, size.prod(), 1e-14, "rounding");
    const Vec3 square = size.cwiseProduct(size);
    const Vec3 principal =
        size.prod() / 12.0 * Vec3(square.y() + square.z(), square.x() + square.z(), square.x() + square.y());
    const Mat3 R = turn.toRotationMatrix();
    CHECK_CLOSE((inertia - R * principal.asDiagonal() * R.transpose()).norm(), 0.0, 1e-14, "rounding");
}

TEST("the six tetrahedra fill a box without gap or overlap") {
    const Vec3 size(2.0, 0.7, 1.3);
    const auto parts = split(box(size));
    // A lattice that meets no face of a tetrahedron: the shares are irrational multiples of each other.
    int outside = 0, twice = 0;
    for (int i = 1; i <= 1000; ++i) {
        const auto share = [i](double step) { return std::fmod(0.5 + i * step, 1.0); };
        const Vec3 p = Vec3(share(0.8191725133961645), share(0.6710436067037893), share(0.5497004779019703))
                           .cwiseProduct(size);
        int hits = 0;
        for (const Tetrahedron& part : parts)
            hits += inside(part, p) ? 1 : 0;
        outside += hits == 0 ? 1 : 0;
        twice += hits > 1 ? 1 : 0;
    }
    CHECK(outside == 0);
    CHECK(twice == 0);
}
