#include "birm3d/model/mass_properties.hpp"

#include <stdexcept>
#include <vector>

#include "check.hpp"

using namespace birm3d;

namespace {

Hexahedron box(const Vec3& low, const Vec3& high) {
    Hexahedron h;
    for (std::size_t i = 0; i < 8; ++i) {
        const bool x = i % 4 == 1 || i % 4 == 2, y = i % 4 >= 2, z = i >= 4;
        h[i] = {x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z()};
    }
    return h;
}

}  // namespace

TEST("two solids of different density: mass, mass centre, parallel axes") {
    const std::vector<Hexahedron> solids = {box({0, 0, 0}, {2, 1, 1}), box({4, 0, 0}, {5, 1, 1})};
    const std::vector<double> densities = {100.0, 600.0};
    const MassProperties p = mass_properties(solids, densities);
    CHECK_CLOSE(p.mass, 800.0, 1e-11, "rounding");
    const double x = (200.0 * 1.0 + 600.0 * 4.5) / 800.0;
    CHECK_CLOSE((p.center_of_mass - Vec3(x, 0.5, 0.5)).norm(), 0.0, 1e-13, "rounding");
    const double along = (200.0 + 600.0) * (1.0 + 1.0) / 12.0;
    const double across = 200.0 * (4.0 + 1.0) / 12.0 + 200.0 * (x - 1.0) * (x - 1.0) + 600.0 * 2.0 / 12.0 +
                          600.0 * (4.5 - x) * (4.5 - x);
    CHECK_CLOSE((p.inertia - Mat3(Vec3(along, across, across).asDiagonal())).norm(), 0.0, 1e-10, "rounding");
}

TEST("a split solid weighs what the whole one does") {
    const std::vector<double> one = {250.0}, two = {250.0, 250.0};
    const std::vector<Hexahedron> whole = {box({-1, -2, 0.5}, {3, 1, 2})};
    const std::vector<Hexahedron> halves = {box({-1, -2, 0.5}, {1, 1, 2}), box({1, -2, 0.5}, {3, 1, 2})};
    const MassProperties a = mass_properties(whole, one), b = mass_properties(halves, two);
    CHECK_CLOSE(a.mass, b.mass, 1e-11, "rounding");
    CHECK_CLOSE((a.center_of_mass - b.center_of_mass).norm(), 0.0, 1e-14, "rounding");
    CHECK_CLOSE((a.inertia - b.inertia).norm() / a.inertia.norm(), 0.0, 1e-14, "rounding");
}

TEST("what is no body is refused") {
    const std::vector<double> density = {1.0}, negative = {-1.0}, nothing = {0.0}, too_many = {1.0, 1.0};
    const std::vector<Hexahedron> good = {box({0, 0, 0}, {1, 1, 1})};
    const std::vector<Hexahedron> inverted = {box({0, 0, 1}, {1, 1, 0})};
    const std::vector<Hexahedron> flat = {box({0, 0, 0}, {1, 1, 0})};
    CHECK_THROWS(mass_properties(inverted, density), std::invalid_argument);
    CHECK_THROWS(mass_properties(flat, density), std::invalid_argument);
    CHECK_THROWS(mass_properties(good, negative), std::invalid_argument);
    CHECK_THROWS(mass_properties(good, nothing), std::invalid_argument);
    CHECK_THROWS(mass_properties(good, too_many), std::invalid_argument);
    CHECK_CLOSE(solid_volume(good[0], 0), 1.0, 1e-15, "rounding");
}
