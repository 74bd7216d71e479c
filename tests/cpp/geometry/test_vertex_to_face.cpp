// The paper's detection (section 5.1, Eq. 8-15) against the exact distance.
#include "check.hpp"
#include "geometry/meshes.hpp"
#include "geometry/random_points.hpp"

using namespace birm3d;

namespace {

const std::vector<Eigen::Vector2d> wall = {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.8}, {0.0, 0.8}};
const std::vector<Eigen::Vector2d> jersey = {{-0.3048, 0.0},   {0.3048, 0.0},    {0.3048, 0.0762},
                                             {0.127, 0.3302},  {0.0762, 0.8128}, {-0.0762, 0.8128},
                                             {-0.127, 0.3302}, {-0.3048, 0.0762}};

TriangleMesh wall_mesh(int parts = 5) {
    return laboratory::extruded(wall, {0.2, 0.4}, -1.0, 1.0, parts).mesh();
}

struct Counts {
    int inside = 0, met = 0, same = 0, nearer = 0, lost = 0, off_surface = 0;
};

// Vertices that have come from outside into the mesh by `step` or less, along random directions.
Counts random_vertices(const TriangleMesh& mesh, double step, unsigned seed) {
    laboratory::Random random(seed);
    const Box bounds = mesh.bounds();
    Counts n;
    while (n.inside < 4000) {
        const Vec3 before =
            random.point(bounds.center - 1.3 * bounds.half, bounds.center + 1.3 * bounds.half);
        const Vec3 direction = random.direction();
        const Vec3 way = random.within(0.0, step) * direction;
        const Vec3 p = before + way;
        const Nearest exact = mesh.nearest(p);
        if (mesh.nearest(before).gap <= 0.0 || exact.gap >= 0.0) continue;
        ++n.inside;
        const auto face = mesh.vertex_to_face(p, way);
        const Nearest contact = mesh.contact(p, way, exact);
        n.lost += contact.gap >= 0.0;
        n.off_surface += std::abs(mesh.nearest(p - contact.gap * contact.normal).gap) > 1e-12;
        if (!face) continue;
        ++n.met;
        n.same += std::abs(face->gap - exact.gap) < 1e-12;
        n.nearer += face->gap > exact.gap + 1e-12;
    }
    return n;
}

Nearest contact(const TriangleMesh& mesh, const Vec3& p, const Vec3& motion) {
    return mesh.contact(p, motion, mesh.nearest(p));
}

}  // namespace

TEST("both conditions met: the face that was passed, and the push-back p - gap n") {
    const TriangleMesh mesh = wall_mesh();
    // 30 mm below the top and 100 mm behind the front, through which it came: the exact nearest is the top.
    const Vec3 p(0.1, 0.03, 0.77), r = Vec3(3.0, 0.4, -0.1);
    const auto face = mesh.vertex_to_face(p, r);
    CHECK(face.has_value());
    CHECK_CLOSE(face->gap, -0.1, 1e-15, "rounding");
    CHECK_CLOSE((face->normal + Vec3::UnitX()).norm(), 0.0, 1e-15, "rounding");
    CHECK_CLOSE(mesh.nearest(p).gap, -0.03, 1e-15, "rounding");
}

TEST("one condition missed: no face, but the vertex is not lost") {
    const TriangleMesh box = wall_mesh(),
                       barrier = laboratory::extruded(jersey, {0.0, 0.2}, -1.0, 1.0, 3).mesh();
    // At rest.
    const Vec3 p(0.1, 0.0, 0.4);
    CHECK(!box.vertex_to_face(p, Vec3::Zero()));
    CHECK_CLOSE(contact(box, p, Vec3::Zero()).gap, -0.1, 1e-15, "the exact nearest");
    // Behind the concave break the normals of both slopes lead past their ends: no P2.
    const Vec3 q = Vec3(0.127, 0.0, 0.3302) + 0.01 * Vec3(-1.0, 0.0, -0.3).normalized();
    const Vec3 inwards(-0.1, 0.0, 0.0);
    CHECK(!barrier.vertex_to_face(q, inwards));
    CHECK_CLOSE(contact(barrier, q, inwards).gap, -0.01, 1e-15, "the exact nearest");
    // Sliding along the front, which it touches: the way back leads to the wall's end, far beyond the motion.
    const Vec3 touching(1e-9, 0.0, 0.4), slide(0.0, 0.02, 0.0);
    CHECK_CLOSE(box.vertex_to_face(touching, slide)->gap, -1.0, 1e-15, "the paper's conditions alone");
    CHECK_CLOSE(contact(box, touching, slide).gap, -1e-9, 1e-15, "the exact nearest");
    // Outside.
    CHECK(!box.vertex_to_face({-0.1, 0.0, 0.4}, Vec3::UnitX()));
    CHECK_CLOSE(contact(box, {-0.1, 0.0, 0.4}, Vec3::UnitX()).gap, 0.1, 1e-15, "the exact nearest");
}

TEST("no vertex that is inside is ever lost; how often both conditions hold") {
    struct {
        const char* name;
        TriangleMesh mesh;
    } meshes[] = {{"wall", wall_mesh()},
                  {"Jersey", laboratory::extruded(jersey, {0.0, 0.2}, -1.0, 1.0, 3).mesh()},
                  {"post of 24 sides", laboratory::post(0.16, -1.0, 1.0, 24).mesh()}};
    for (const auto& [name, mesh] : meshes)
        for (const double step : {0.02, 0.2}) {
            const Counts n = random_vertices(mesh, step, 21);
            std::printf(
                "    %s, steps up to %g m: %d inside, both conditions %.1f %%, of these the exact nearest "
                "%.1f %%\n",
                name, step, n.inside, 100.0 * n.met / n.inside, 100.0 * n.same / n.met);
            CHECK(n.lost == 0);
            CHECK(n.off_surface == 0);
            CHECK(n.nearer == 0);  // a face can not be nearer than the nearest
            // Deep behind the narrow sides of a post P2 often lies beside the side that was passed.
            CHECK(n.met > (step < 0.1 ? 0.9 : 0.4) * n.inside);
        }
}

TEST("how a flat face is divided does not matter: no contact at internal edges") {
    const TriangleMesh coarse = wall_mesh(1), fine = wall_mesh(40);
    laboratory::Random random(17);
    int met = 0;
    for (int i = 0; i < 6000; ++i) {
        const Vec3 p = random.point({0.0, -1.0, 0.0}, {0.4, 1.0, 0.8}), r = random.direction();
        const auto a = coarse.vertex_to_face(p, r), b = fine.vertex_to_face(p, r);
        CHECK(a.has_value() == b.has_value());
        if (!a || !b) continue;
        ++met;
        CHECK_CLOSE(a->gap, b->gap, 1e-14, "rounding");
        CHECK_CLOSE((a->normal - b->normal).norm(), 0.0, 1e-14, "one plane");
    }
    CHECK(met > 1500);
    // On the lines that divide the front, and just beside them.
    for (int j = 0; j <= 40; ++j)
        for (const double beside : {-1e-9, -1e-15, 0.0, 1e-15, 1e-9}) {
            const double y = -1.0 + 2.0 * j / 40 + beside;
            if (std::abs(y) > 0.999) continue;
            const auto n = fine.vertex_to_face({0.01, y, 0.4}, Vec3::UnitX());
            CHECK(n.has_value());
            CHECK_CLOSE(n->gap, -0.01, 1e-15, "rounding");
            const Nearest above = fine.nearest({-1e-9, y, 0.4});
            CHECK_CLOSE((above.normal + Vec3::UnitX()).norm(), 0.0, 0.0, "the face's own normal, exactly");
        }
}

TEST("fast vertices: the way back finds the face that was passed, however deep") {
    const TriangleMesh mesh = laboratory::extruded(jersey, {0.0, 0.2}, -1.0, 1.0, 3).mesh();
    // Through the stem past its middle: the nearest face is the rear one, the passed one the front.
    const Vec3 p(0.05, 0.0, 0.6);
    CHECK(mesh.nearest(p).normal.x() > 0.9);
    const auto passed = mesh.vertex_to_face(p, Vec3(25.0, 1.0, 0.0));
    CHECK(passed && passed->normal.x() < -0.9);
}
