#include "birm3d/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <string>

#include "birm3d/base/error.hpp"
#include "check.hpp"
#include "geometry/meshes.hpp"
#include "geometry/shape_laws.hpp"

using namespace birm3d;
using laboratory::MeshArrays;

namespace {

constexpr double pi = 3.141592653589793;

const Prism::Profile box_profile = {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.8}, {0.0, 0.8}};
// A New Jersey barrier, 32 in, and the point its outline is seen from as a whole.
const Prism::Profile jersey_profile = {{-0.3048, 0.0},   {0.3048, 0.0},    {0.3048, 0.0762},
                                       {0.127, 0.3302},  {0.0762, 0.8128}, {-0.0762, 0.8128},
                                       {-0.127, 0.3302}, {-0.3048, 0.0762}};

MeshArrays box(int parts = 1) {
    return laboratory::extruded(box_profile, {0.2, 0.4}, -0.5, 0.7, parts);
}

MeshArrays jersey(int parts) {
    return laboratory::extruded(jersey_profile, {0.0, 0.2}, -1.0, 1.0, parts);
}

struct Difference {
    double gap = 0.0, place = 0.0;
};

// Between a mesh and an exact shape: of the gaps, and of the points that push-back leads to where the shape has
// one nearest point (two points apart can be equally near).
template <class Exact>
Difference compare(const TriangleMesh& mesh, const Exact& exact, const Vec3& low, const Vec3& high) {
    laboratory::Random random(11);
    Difference worst;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p = random.point(low, high);
        const Nearest a = mesh.nearest(p), b = exact(p);
        worst.gap = std::max(worst.gap, std::abs(a.gap - b.gap));
        worst.place = std::max(worst.place, std::abs(exact(p - a.gap * a.normal).gap));
    }
    return worst;
}

std::string message_of(const MeshArrays& arrays) {
    try {
        arrays.mesh();
    } catch (const InvalidArgument& e) {
        return e.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST("a box and a Jersey barrier of triangles are the exact prisms") {
    for (const int parts : {1, 7}) {
        const Prism exact_box(box_profile, -0.5, 0.7, {}), exact_jersey(jersey_profile, -1.0, 1.0, {});
        const Difference of_box =
            compare(box(parts).mesh(), [&](const Vec3& p) { return exact_box.nearest(p); },
                    {-0.5, -1.0, -0.5}, {1.0, 1.2, 1.5});
        CHECK_CLOSE(of_box.gap, 0.0, 1e-14, "rounding");
        CHECK_CLOSE(of_box.place, 0.0, 1e-14, "rounding");
        const Difference of_jersey =
            compare(jersey(parts).mesh(), [&](const Vec3& p) { return exact_jersey.nearest(p); },
                    {-1.0, -1.5, -0.5}, {1.0, 1.5, 1.5});
        CHECK_CLOSE(of_jersey.gap, 0.0, 1e-14, "rounding");
        CHECK_CLOSE(of_jersey.place, 0.0, 1e-14, "rounding");
    }
}

TEST("a post of n sides lies within radius (1 - cos(pi/n)) of the round one, and comes that far off") {
    const double radius = 0.3, height = 1.0;
    const Post round(radius, height);
    for (const int n : {6, 24, 96}) {
        const double bound = radius * (1.0 - std::cos(pi / n));
        const Difference worst =
            compare(laboratory::post(radius, -3.0, height, n).mesh(),
                    [&](const Vec3& p) { return nearest(round, p); }, {-1.0, -1.0, -0.5}, {1.0, 1.0, 1.8});
        CHECK(worst.gap <= bound * (1.0 + 1e-9));
        CHECK(worst.gap >= 0.95 * bound);
    }
}

TEST("the gap of a closed mesh is a distance and its normal the gradient") {
    for (const MeshArrays& arrays : {box(3), jersey(2), laboratory::post(0.4, -0.3, 0.9, 7)}) {
        const TriangleMesh mesh = arrays.mesh();
        laboratory::check_distance_laws([&](const Vec3& p) { return mesh.nearest(p); }, {-0.5, -1.2, -0.5},
                                        {1.0, 1.2, 1.5}, 1.0, 10000, 7);
    }
}

TEST("at corners the weight of the angles decides the sign, not how a face is divided") {
    // A spike, seen from beyond its tip: some of its faces look away from points that are outside.
    MeshArrays spike;
    spike.vertices = {{0.0, 0.0, 0.0}, {1.0, 0.05, 0.1}, {1.0, -0.05, 0.1}, {1.0, 0.0, -1.0}};
    spike.faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    const TriangleMesh mesh = spike.mesh();
    laboratory::Random random(3);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = random.point({-0.5, -0.5, -0.5}, {-0.001, 0.5, 0.5});
        CHECK(mesh.nearest(p).gap > 0.0);
    }
}

TEST("a hint changes the time, not the answer") {
    const TriangleMesh mesh = jersey(9).mesh();
    laboratory::Random random(9);
    std::size_t hint = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = random.point({-1.0, -1.5, -0.5}, {1.0, 1.5, 1.5});
        CHECK_CLOSE(mesh.nearest(p, hint).gap, mesh.nearest(p).gap, 1e-15, "ties are broken either way");
        CHECK(hint < mesh.triangle_count());
    }
}

TEST("a closed mesh turned inside out is turned back") {
    MeshArrays arrays = box();
    for (auto& face : arrays.faces)
        std::swap(face[0], face[1]);
    CHECK_CLOSE(arrays.mesh().nearest({0.1, 0.0, 0.4}).gap, -0.1, 1e-15, "rounding");
    CHECK_CLOSE(arrays.mesh().nearest({-0.1, 0.0, 0.4}).gap, 0.1, 1e-15, "rounding");
}

TEST("an open mesh: behind it is inside, beside its rim is outside") {
    MeshArrays sheet;
    sheet.vertices = {{0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 1.0, 1.0}, {0.0, -1.0, 1.0}};
    sheet.quad(3, 2, 1, 0);
    const TriangleMesh mesh = sheet.mesh();
    CHECK(!mesh.closed());
    CHECK(std::isinf(mesh.thickness()));
    CHECK_CLOSE(mesh.nearest({-0.3, 0.2, 0.2}).gap, 0.3, 1e-15, "rounding");
    CHECK_CLOSE((mesh.nearest({-0.3, 0.2, 0.2}).normal + Vec3::UnitX()).norm(), 0.0, 1e-15, "rounding");
    CHECK_CLOSE(mesh.nearest({0.3, 0.2, 0.2}).gap, -0.3, 1e-15, "rounding");
    CHECK_CLOSE(mesh.nearest({0.3, 1.4, 0.2}).gap, 0.5, 1e-15, "rounding");
    // A box without a bottom: inside it the rest counts, as with a covered bottom.
    MeshArrays hood = box();
    std::erase_if(hood.faces, [&](const TriangleMesh::Face& f) {
        return std::all_of(f.begin(), f.end(),
                           [&](auto v) { return hood.vertices[static_cast<std::size_t>(v)].z() == 0.0; });
    });
    CHECK(!hood.mesh().closed());
    CHECK_CLOSE(hood.mesh().nearest({0.15, 0.0, 0.01}).gap, -0.15, 1e-15, "rounding");
    CHECK_CLOSE(hood.mesh().nearest({0.15, 0.0, -0.2}).gap, 0.25, 1e-15, "rounding");
}

TEST("bounds and thickness") {
    CHECK_CLOSE(box(2).mesh().thickness(), 0.4, 1e-14, "from face to face");
    CHECK_CLOSE((box().mesh().bounds().center - Vec3(0.2, 0.1, 0.4)).norm(), 0.0, 1e-8, "boxes have slack");
    CHECK_CLOSE((box().mesh().bounds().half - Vec3(0.2, 0.6, 0.4)).norm(), 0.0, 1e-8, "boxes have slack");
    const double jersey_thickness = jersey(4).mesh().thickness();
    CHECK(jersey_thickness > 2.0 * 0.0762 && jersey_thickness < 2.0 * 0.127);
    const double post_thickness = laboratory::post(0.3, -3.0, 1.0, 24).mesh().thickness();
    CHECK_CLOSE(post_thickness, 0.6 * std::cos(pi / 24), 1e-12, "between opposite sides");
}

TEST("vertices at the same place are one") {
    const MeshArrays shared = box(2);
    MeshArrays soup;
    for (const auto& face : shared.faces) {
        const auto n = static_cast<std::int64_t>(soup.vertices.size());
        for (const auto v : face)
            soup.vertices.push_back(shared.vertices[static_cast<std::size_t>(v)]);
        soup.faces.push_back({n, n + 1, n + 2});
    }
    CHECK(soup.mesh().closed());
    CHECK_CLOSE(soup.mesh().nearest({0.3, 0.69, 0.79}).gap, -0.01, 1e-15, "rounding");
}

TEST("meshes that are none are refused, and the message names the culprit") {
    MeshArrays bad = box();
    bad.faces.clear();
    CHECK(contains(message_of(bad), "faces must be 1 or more, got 0"));
    bad = box();
    bad.faces[3][1] = 99;
    CHECK(contains(message_of(bad), "faces[3]") && contains(message_of(bad), "99"));
    bad.faces[3][1] = -1;
    CHECK(contains(message_of(bad), "-1"));
    bad = box();
    bad.vertices[2].y() = std::nan("");
    CHECK(contains(message_of(bad), "vertices[2]"));
    bad = box();
    bad.faces[5] = {1, 1, 2};
    CHECK(contains(message_of(bad), "faces[5]"));
    bad = box();
    bad.vertices.emplace_back(0.2, -0.5, 1e-12);
    bad.faces[0] = {0, static_cast<std::int64_t>(bad.vertices.size()) - 1, 1};
    CHECK(contains(message_of(bad), "faces[0]"));
    bad = box();
    std::swap(bad.faces[4][0], bad.faces[4][1]);
    CHECK(contains(message_of(bad), "opposite directions") && contains(message_of(bad), "faces[4]"));
    bad = box();
    bad.vertices.emplace_back(5.0, 5.0, 5.0);
    bad.faces.push_back(
        {bad.faces[0][0], bad.faces[0][1], static_cast<std::int64_t>(bad.vertices.size()) - 1});
    const auto [low, high] = std::minmax(bad.faces[0][0], bad.faces[0][1]);
    const std::string name = std::to_string(low) + "-" + std::to_string(high);
    CHECK(contains(message_of(bad), "two faces at the most") && contains(message_of(bad), "edge " + name));
}
