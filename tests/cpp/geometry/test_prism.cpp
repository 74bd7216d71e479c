#include "birm3d/geometry/prism.hpp"

#include <cmath>

#include "birm3d/base/error.hpp"
#include "check.hpp"
#include "geometry/shape_laws.hpp"

using namespace birm3d;

namespace {

void check_nearest(const Prism& prism, const Vec3& p, double gap, const Vec3& normal) {
    const Nearest n = prism.nearest(p);
    CHECK_CLOSE(n.gap, gap, 1e-14, "rounding");
    CHECK_CLOSE((n.normal - normal).norm(), 0.0, 1e-14, "rounding");
}

// New Jersey, 32 in: toe 75 mm, 55 degrees up to 330 mm, 84 degrees up to 810 mm.
const Prism::Profile jersey_half = {{0.3048, 0.0}, {0.3048, 0.0762}, {0.127, 0.3302}, {0.0762, 0.8128}};

// Its right half as a body of its own; edge 5 is the bottom.
const Prism::Profile cut_jersey = {{0.3048, 0.0},    {0.3048, 0.0762}, {0.127, 0.3302},
                                   {0.0762, 0.8128}, {0.0, 0.8128},    {0.0, 0.0}};

const Prism::Profile notched = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.5, 0.4}, {0.0, 1.0}};

}  // namespace

TEST("faces, edges and corners of a finite wall") {
    const Prism wall = Prism::box(0.4, 4.0, 1.0);
    check_nearest(wall, {-0.7, 1.0, 0.5}, 0.7, -Vec3::UnitX());
    check_nearest(wall, {0.1, 1.0, 0.5}, -0.1, -Vec3::UnitX());
    check_nearest(wall, {0.3, 1.0, 0.5}, -0.1, Vec3::UnitX());
    check_nearest(wall, {0.2, 1.0, 0.95}, -0.05, Vec3::UnitZ());
    check_nearest(wall, {0.2, 1.95, 0.5}, -0.05, Vec3::UnitY());
    check_nearest(wall, {0.2, -2.5, 0.5}, 0.5, -Vec3::UnitY());
    check_nearest(wall, {-0.3, 1.0, 1.4}, 0.5, {-0.6, 0.0, 0.8});
    check_nearest(wall, {-0.3, 2.4, 0.5}, 0.5, {-0.6, 0.8, 0.0});
    check_nearest(wall, {0.4 + 0.1, -2.2, 1.2}, 0.3, {1.0 / 3.0, -2.0 / 3.0, 2.0 / 3.0});
    CHECK_CLOSE(wall.thickness(), 0.4, 1e-15, "from face to face");
    CHECK_CLOSE((wall.bounds().center - Vec3(0.2, 0.0, 0.5)).norm(), 0.0, 1e-15, "rounding");
    CHECK_CLOSE((wall.bounds().half - Vec3(0.2, 2.0, 0.5)).norm(), 0.0, 1e-15, "rounding");
}

TEST("nothing is pushed out through the ground, nor through a covered end") {
    const Prism wall = Prism::box(0.4, 4.0, 1.0);
    check_nearest(wall, {0.1, 0.0, 0.001}, -0.1, -Vec3::UnitX());
    // Under it the distance to the rest counts: the lower edge of the front.
    check_nearest(wall, {0.03, 0.0, -0.04}, 0.05, {0.6, 0.0, -0.8});
    check_nearest(Prism::box(0.4, 4.0, 1.0, 2.0), {0.1, 0.0, -1.9}, -0.1, -Vec3::UnitX());
    const Prism segment = wall.with_covered_ends(true, false);
    check_nearest(segment, {0.1, -1.999, 0.5}, -0.1, -Vec3::UnitX());
    check_nearest(segment, {0.03, -2.04, 0.5}, 0.05, {0.6, -0.8, 0.0});
    check_nearest(segment, {0.1, 1.999, 0.5}, -0.001, Vec3::UnitY());
    check_nearest(wall.with_covered_ends(false, true), {0.1, -1.999, 0.5}, -0.001, -Vec3::UnitY());
    // The corners of an end that stands on the ground belong to the end.
    check_nearest(wall, {0.2, 2.04, -0.03}, 0.05, {0.0, 0.8, -0.6});
    CHECK_CLOSE(segment.no_nearer({{0.2, 0.0, -0.3}, Vec3::Zero()}), 0.3, 1e-15, "the solid has a bottom");
}

TEST("no point of a box is nearer than its bound, and of a small one it is hardly less") {
    laboratory::Random random(9);
    for (const Prism& prism : {Prism::symmetric(jersey_half, infinity, 1.0), Prism(notched, -1.0, 1.0, {})}) {
        double slack = 0.0;
        for (int i = 0; i < 4000; ++i) {
            const Box box{random.point({-1.5, -0.8, -0.5}, {2.0, 0.8, 2.0}),
                          0.2 * random.point({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0})};
            const double bound = prism.no_nearer(box);
            for (int j = 0; j < 10; ++j) {
                const Vec3 p = box.center + box.half.cwiseProduct(random.point({-1, -1, -1}, {1, 1, 1}));
                CHECK(bound == 0.0 || prism.nearest(p).gap >= bound - 1e-12);  // rounding
            }
            const double gap = prism.nearest(box.center).gap;
            if (gap > 0.0 && box.center.z() > 0.0)
                slack = std::max(slack, gap - prism.no_nearer({box.center, Vec3::Constant(1e-6)}));
        }
        CHECK(slack < 2e-6);
    }
}

TEST("a wall cut into segments is the same wall") {
    const Prism whole = Prism::box(0.5, 6.0, 0.8);
    const auto segment = [&](double low, double high, bool first, bool last) {
        return Prism({{0.0, 0.0}, {0.5, 0.0}, {0.5, 0.8}, {0.0, 0.8}}, low, high,
                     {.edges = {0}, .low_end = !first, .high_end = !last});
    };
    const Prism parts[] = {segment(-3.0, -1.2, true, false), segment(-1.2, 1.7, false, false),
                           segment(1.7, 3.0, false, true)};
    laboratory::Random random(5);
    double worst = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p = random.point({-1.0, -4.0, 0.0}, {1.5, 4.0, 1.5});
        const Nearest exact = whole.nearest(p);
        Nearest best{infinity, Vec3::Zero()};
        for (const Prism& part : parts) {
            const Nearest n = part.nearest(p);
            if (n.gap < best.gap) best = n;
        }
        worst = std::max({worst, std::abs(best.gap - exact.gap), (best.normal - exact.normal).norm()});
    }
    CHECK_CLOSE(worst, 0.0, 1e-12, "rounding; segments are longer than half the thickness");
}

TEST("walls without ends or top") {
    const Prism wall = Prism::box(0.4, infinity, infinity);
    check_nearest(wall, {-0.7, 1e5, 1e5}, 0.7, -Vec3::UnitX());
    check_nearest(wall, {0.1, -1e5, 1e5}, -0.1, -Vec3::UnitX());
    check_nearest(wall, {0.3, 0.0, 0.0}, -0.1, Vec3::UnitX());
    CHECK(std::isinf(wall.bounds().half.z()) && wall.bounds().center.allFinite());
    const Prism low = Prism::box(0.4, infinity, 0.9);
    check_nearest(low, {0.2, 1e5, 1.0}, 0.1, Vec3::UnitZ());
    const Prism tall = Prism::box(0.4, 3.0, infinity);
    check_nearest(tall, {0.2, 1.6, 1e4}, 0.1, Vec3::UnitY());
}

TEST("chords of a rounded corner are no thickness") {
    // The normals are at 0, 16, 69, 110 and 180 degrees: the second and the fourth look away from each other.
    const Prism wall({{0.0, -1.0}, {0.4, -1.0}, {0.4, 0.9}, {0.38, 0.97}, {0.3, 1.0}, {0.0, 0.89}}, -1.0, 1.0,
                     {});
    CHECK_CLOSE(wall.thickness(), std::hypot(0.38, 0.08), 1e-15, "from the first chord to the other side");
}

TEST("a Jersey profile: slopes, the concave break, the top") {
    const Prism jersey = Prism::symmetric(jersey_half, infinity);
    CHECK_CLOSE(jersey.thickness(), 2.0 * 0.0762, 1e-15, "the top is the narrowest place");
    check_nearest(jersey, {0.0, 0.0, 0.9}, 0.9 - 0.8128, Vec3::UnitZ());
    check_nearest(jersey, {-0.5, 3.0, 0.03}, 0.5 - 0.3048, -Vec3::UnitX());
    const Vec3 along = Vec3(0.3048 - 0.127, 0.0, 0.0762 - 0.3302).normalized();  // the lower slope, x > 0
    const Vec3 out(-along.z(), 0.0, along.x());
    const Vec3 foot(0.2, 0.0, 0.0762 + (0.3048 - 0.2) * (0.3302 - 0.0762) / (0.3048 - 0.127));
    check_nearest(jersey, foot + 0.1 * out, 0.1, out);
    check_nearest(jersey, foot - 0.05 * out, -0.05, out);
    check_nearest(jersey, foot.cwiseProduct(Vec3(-1.0, 1.0, 1.0)) + 0.1 * Vec3(-out.x(), 0.0, out.z()), 0.1,
                  Vec3(-out.x(), 0.0, out.z()));
    // Inside, the break is the nearest point of a whole fan of points.
    const Vec3 inwards = Vec3(-1.0, 0.0, -0.3).normalized();
    check_nearest(jersey, Vec3(0.127, 0.0, 0.3302) + 0.01 * inwards, -0.01, -inwards);
}

TEST("the orientation of a profile does not matter, nor does that of its cover") {
    const Prism::Profile turned(notched.rbegin(), notched.rend());
    const Prism a(notched, -1.0, 1.0, {.edges = {0, 3}}), b(turned, -1.0, 1.0, {.edges = {3, 0}});
    laboratory::Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p = random.point({-0.5, -1.5, -0.5}, {1.5, 1.5, 1.5});
        CHECK_CLOSE(a.nearest(p).gap, b.nearest(p).gap, 1e-15, "rounding");
        CHECK_CLOSE((a.nearest(p).normal - b.nearest(p).normal).norm(), 0.0, 1e-12, "rounding near edges");
    }
}

TEST("the gap of a prism is a distance and its normal the gradient") {
    for (const Prism& prism : {Prism(notched, -0.7, 0.9, {}), Prism(cut_jersey, -0.7, infinity, {}),
                               Prism({{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.8}, {0.0, 0.8}}, -0.5, 0.5, {})})
        laboratory::check_distance_laws([&](const Vec3& p) { return prism.nearest(p); }, {-0.5, -1.5, -0.5},
                                        {1.5, 1.5, 1.5}, 1.0, 20000, 3);
}

TEST(
    "above the ground a covered bottom changes nothing outside, and inside the distance to the rest counts") {
    const Prism bare(cut_jersey, -1.0, 1.0, {}), standing(cut_jersey, -1.0, 1.0, {.edges = {5}});
    laboratory::Random random(4);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = random.point({-0.5, -1.5, 0.0}, {1.0, 1.5, 1.0});
        const double gap = bare.nearest(p).gap, rest = standing.nearest(p).gap;
        CHECK((gap < 0.0) == (rest < 0.0));
        CHECK(rest <= gap + 1e-15 || gap > 0.0);
    }
}

TEST("profiles that are none are refused") {
    const auto prism = [](const Prism::Profile& profile) { return Prism(profile, 0.0, 1.0, {}); };
    CHECK_THROWS(prism({{0.0, 0.0}, {1.0, 0.0}}), InvalidArgument);
    CHECK_THROWS(prism({{0.0, 0.0}, {1.0, 0.0}, {std::nan(""), 1.0}}), InvalidArgument);
    CHECK_THROWS(prism({{0.0, 0.0}, {1.0, 0.0}, {1.0, infinity}}), InvalidArgument);
    CHECK_THROWS(prism({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}), InvalidArgument);
    CHECK_THROWS(prism({{0.0, 0.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}}), InvalidArgument);
    CHECK_THROWS(prism({{0.0, 0.0}, {1.0, 0.0}, {0.4, 0.0}}), InvalidArgument);
    CHECK_THROWS(prism({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.5, 0.0}, {0.0, 1.0}}), InvalidArgument);
    CHECK_THROWS(Prism(notched, 1.0, 1.0, {}), InvalidArgument);
    CHECK_THROWS(Prism(notched, 0.0, std::nan(""), {}), InvalidArgument);
    CHECK_THROWS(Prism(notched, 0.0, 1.0, {.edges = {5}}), InvalidArgument);
    CHECK_THROWS(Prism(notched, -infinity, infinity, {.edges = {0, 1, 2, 3, 4}}), InvalidArgument);
    CHECK_THROWS(Prism::box(0.0, 1.0, 1.0), InvalidArgument);
    CHECK_THROWS(Prism::box(0.4, -1.0, 1.0), InvalidArgument);
    CHECK_THROWS(Prism::box(0.4, 1.0, 0.0), InvalidArgument);
    CHECK_THROWS(Prism::symmetric({{0.3, 0.0}}, 1.0), InvalidArgument);
    CHECK_THROWS(Prism::symmetric({{0.3, 0.0}, {0.0, 0.5}, {0.2, 0.8}}, 1.0), InvalidArgument);
}
