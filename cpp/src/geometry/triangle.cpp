#include "geometry/triangle.hpp"

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

double area_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    return 0.5 * (b - a).cross(c - b).norm();
}

bool holds(const Triangle& t, const Vec3& p) {
    const double parts = area_of(t.corner[0], t.corner[1], p) + area_of(t.corner[1], t.corner[2], p) +
                         area_of(t.corner[2], t.corner[0], p);
    return parts <= (1.0 + tolerance::triangle_area) * t.area;
}

PlainTriangle plain_triangle(const std::array<Vec3, 3>& corner) {
    const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    PlainTriangle out{{}, normal.x(), normal.y(), normal.z()};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = corner[(i + 1) % 3] - corner[i], outward = edge.cross(normal);
        out.side[i] = {corner[i].x(), corner[i].y(), corner[i].z(), edge.x(),    edge.y(),
                       edge.z(),      outward.x(),   outward.y(),   outward.z(), 1.0 / edge.squaredNorm()};
    }
    return out;
}

OnTriangle nearest_on(const Triangle& t, const Vec3& p) {
    return nearest_on_plain(t.plain, p.x(), p.y(), p.z());
}

}  // namespace birm3d
