#include "triangle.hpp"

namespace birm3d {

OnTriangle nearest_on(const Triangle& t, const Vec3& p) {
    // Coordinates of the point along each edge, from either end; weights w of the corners times area squared.
    std::array<double, 3> from_start, from_end;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = t.corner[(i + 1) % 3] - t.corner[i];
        from_start[i] = edge.dot(p - t.corner[i]);
        from_end[i] = edge.dot(t.corner[(i + 1) % 3] - p);
    }
    for (std::size_t i = 0; i < 3; ++i)
        if (from_start[i] <= 0.0 && from_end[(i + 2) % 3] <= 0.0) return {t.corner[i], corner_0 + i};
    const Vec3 across = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 &a = t.corner[i], &b = t.corner[(i + 1) % 3];
        const double weight = across.dot((b - a).cross(p - a));
        if (weight <= 0.0 && from_start[i] >= 0.0 && from_end[i] >= 0.0)
            return {a + from_start[i] / (b - a).squaredNorm() * (b - a), edge_0 + i};
    }
    const double height = across.dot(p - t.corner[0]) / across.squaredNorm();
    return {p - height * across, inner};
}

}  // namespace birm3d
