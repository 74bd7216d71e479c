#include "birm3d/geometry/triangle_mesh.hpp"

#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "geometry/triangle_mesh_data.hpp"

namespace birm3d {

namespace {

// Does some triangle of the flat face hold a point of its plane?
bool face_holds(const TriangleMeshData& mesh, std::size_t face, const Vec3& p) {
    bool found = false;
    mesh.tree.along(p, Vec3::Zero(), 0.0, [&](std::size_t i) {
        found = found || (mesh.triangles[i].face == face && holds(mesh.triangles[i], p));
    });
    return found;
}

// From the middle of each triangle straight through the body to where it ends, the least of all.
double least_thickness(const TriangleMeshData& mesh) {
    double thickness = infinity;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 middle = (t.corner[0] + t.corner[1] + t.corner[2]) / 3.0;
        mesh.tree.along(middle, -t.normal, thickness, [&](std::size_t i) {
            const Triangle& other = mesh.triangles[i];
            const double along = -t.normal.dot(other.normal);
            if (other.face == t.face || along <= 0.0) return;
            const double depth = (other.offset - other.normal.dot(middle)) / along;
            if (depth > 0.0 && depth < thickness && holds(other, middle - depth * t.normal))
                thickness = depth;
        });
    }
    return thickness;
}

double size_of(const std::vector<Triangle>& triangles) {
    const auto corner = [&](std::size_t i) { return triangles[i / 3].corner[i % 3]; };
    return Box::around(3 * triangles.size(), corner).half.norm();
}

}  // namespace

Nearest nearest_from(const Triangle& t, const OnTriangle& on, const Vec3& p) {
    const auto part = static_cast<std::size_t>(on.part);
    if (t.vicinity[part] == Vicinity::flat) return {t.normal.dot(p) - t.offset, t.normal};
    const Vec3 from(on.x, on.y, on.z);
    const double distance = std::sqrt(on.square);
    const bool outside = t.vicinity[part] == Vicinity::rim || t.pseudo_normal[part].dot(from) >= 0.0;
    const double sign = outside ? 1.0 : -1.0;
    if (!(distance > tolerance::edge_radius)) return {sign * distance, t.normal};
    return {sign * distance, sign / distance * from};
}

TriangleMesh::TriangleMesh(const std::vector<Vec3>& vertices, const std::vector<Face>& faces) {
    auto data = std::make_shared<TriangleMeshData>();
    data->triangles = triangles_of(vertices, faces, data->closed);
    // By rounding, points of a flat face may lie this far beside their triangles.
    data->tree = TriangleTree(data->triangles, tolerance::triangle_area * size_of(data->triangles));
    data->thickness = least_thickness(*data);
    data_ = std::move(data);
}

Nearest TriangleMesh::nearest(const Vec3& p) const {
    std::size_t hint = 0;
    return nearest(p, hint);
}

Nearest TriangleMesh::nearest(const Vec3& p, std::size_t& hint) const {
    const std::vector<Triangle>& triangles = data_->triangles;
    std::size_t best = hint < triangles.size() ? hint : 0;
    OnTriangle on = nearest_on(triangles[best], p);
    data_->tree.near(p, p, on.square, [&](std::size_t i) {
        const double ahead = ahead_of(triangles[i].plain, p.x(), p.y(), p.z());
        if (ahead * ahead >= on.square) return;
        const OnTriangle candidate = nearest_on(triangles[i], p);
        if (candidate.square < on.square) {
            on = candidate;
            best = i;
        }
    });
    hint = best;
    return nearest_from(triangles[best], on, p);
}

std::optional<Nearest> TriangleMesh::vertex_to_face(const Vec3& p, const Vec3& direction,
                                                    double longest) const {
    const double speed = direction.norm();
    if (!(speed > 0.0)) return std::nullopt;
    const Vec3 r = direction / speed;
    std::optional<Nearest> best;
    data_->tree.along(p, -r, longest, [&](std::size_t i) {
        const Triangle& t = data_->triangles[i];
        // Eq. 9 to 12: the offset is D, n . p is Y, and X is r . n.
        const double X = r.dot(t.normal), gap = t.normal.dot(p) - t.offset;
        if (!(X < 0.0 && gap <= 0.0) || (best && gap <= best->gap)) return;
        if (gap < longest * X) return;
        if (!holds(t, p - gap / X * r)) return;                       // P1, Eq. 13
        if (!face_holds(*data_, t.face, p - gap * t.normal)) return;  // P2, Eq. 14
        best = Nearest{gap, t.normal};
    });
    return best;
}

Nearest TriangleMesh::contact(const Vec3& p, const Vec3& motion, const Nearest& exact) const {
    if (exact.gap >= 0.0) return exact;
    // The limit keeps a vertex that slides along a wall from finding the end of the wall behind it.
    const double longest = motion.norm() + tolerance::touching_gap;
    return vertex_to_face(p, motion, longest).value_or(exact);
}

Box TriangleMesh::bounds() const {
    const Vec3 &low = data_->tree.low(), &high = data_->tree.high();
    return {0.5 * (low + high), 0.5 * (high - low)};
}

double TriangleMesh::thickness() const {
    return data_->thickness;
}

bool TriangleMesh::closed() const {
    return data_->closed;
}

const std::array<Vec3, 3>& TriangleMesh::corners(std::size_t triangle) const {
    return data_->triangles.at(triangle).corner;
}

std::size_t TriangleMesh::triangle_count() const {
    return data_->triangles.size();
}

}  // namespace birm3d
