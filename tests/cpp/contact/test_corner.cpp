#include "contact/corner.hpp"

#include "check.hpp"

using namespace birm3d;

namespace {

CornerFace face_with(const Vec3& normal, double gap) {
    CornerFace face;
    face.normal = face.gradient = face.direction = normal;
    face.gap = gap;
    return face;
}

// The faces of an inner corner 30 degrees apart, of which the truss pushes on the first alone.
Corner corner_with(double first, double second) {
    Corner corner;
    corner.add(face_with(Vec3::UnitX(), first));
    corner.add(face_with({std::cos(std::numbers::pi / 6.0), 0.0, std::sin(std::numbers::pi / 6.0)}, second));
    corner.distribute(Vec3(1.0, 0.0, -0.2).normalized());
    return corner;
}

}  // namespace

TEST("a face without force is released where the others move the node out of it") {
    Corner out = corner_with(-0.01, -0.008);
    CHECK(out.face[0].weight > 0.0);
    CHECK(out.face[1].weight == 0.0);
    out.release();
    CHECK(out.count == 1);
    CHECK_CLOSE((out.displacement() - 0.01 * Vec3::UnitX()).norm(), 0.0, 1e-17, "on the first face");

    Corner inside = corner_with(-0.01, -0.009);
    inside.release();
    CHECK(inside.count == 2);
    const Vec3 to = inside.displacement();
    CHECK_CLOSE(to.dot(inside.face[0].normal), 0.01, 1e-16, "on both");
    CHECK_CLOSE(to.dot(inside.face[1].normal), 0.009, 1e-16, "on both");
}
