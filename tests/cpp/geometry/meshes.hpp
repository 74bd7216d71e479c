// Triangulated copies of the exact shapes.
#pragma once

#include <cmath>
#include <vector>

#include "birm3d/geometry/triangle_mesh.hpp"

namespace laboratory {

struct MeshArrays {
    std::vector<birm3d::Vec3> vertices;
    std::vector<birm3d::TriangleMesh::Face> faces;

    birm3d::TriangleMesh mesh() const { return {vertices, faces}; }
    void quad(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
        faces.push_back({a, b, c});
        faces.push_back({a, c, d});
    }
};

// A closed profile (x, z), counter-clockwise with x to the right and z up, star-shaped about `hub`, drawn from
// y_low to y_high in `parts` equal parts.
inline MeshArrays extruded(const std::vector<Eigen::Vector2d>& profile, const Eigen::Vector2d& hub,
                           double y_low, double y_high, int parts) {
    MeshArrays out;
    const auto n = static_cast<std::int64_t>(profile.size());
    for (int j = 0; j <= parts; ++j) {
        const double y = j == parts ? y_high : y_low + (y_high - y_low) * j / parts;
        for (const Eigen::Vector2d& p : profile)
            out.vertices.emplace_back(p.x(), y, p.y());
    }
    for (std::int64_t j = 0; j < parts; ++j)
        for (std::int64_t i = 0; i < n; ++i) {
            const std::int64_t a = j * n + i, b = j * n + (i + 1) % n;
            out.quad(a, a + n, b + n, b);
        }
    const auto low = static_cast<std::int64_t>(out.vertices.size()), high = low + 1, last = parts * n;
    out.vertices.emplace_back(hub.x(), y_low, hub.y());
    out.vertices.emplace_back(hub.x(), y_high, hub.y());
    for (std::int64_t i = 0; i < n; ++i) {
        out.faces.push_back({low, i, (i + 1) % n});
        out.faces.push_back({high, last + (i + 1) % n, last + i});
    }
    return out;
}

// A post with n sides, its corners on the circle of the radius, from z = low to z = high.
inline MeshArrays post(double radius, double low, double high, std::int64_t n) {
    MeshArrays out;
    for (const double z : {low, high})
        for (std::int64_t i = 0; i < n; ++i) {
            const double angle = 2.0 * 3.141592653589793 * static_cast<double>(i) / static_cast<double>(n);
            out.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
        }
    const std::int64_t bottom = 2 * n, top = 2 * n + 1;
    out.vertices.emplace_back(0.0, 0.0, low);
    out.vertices.emplace_back(0.0, 0.0, high);
    for (std::int64_t i = 0; i < n; ++i) {
        const std::int64_t k = (i + 1) % n;
        out.quad(i, k, k + n, i + n);
        out.faces.push_back({bottom, k, i});
        out.faces.push_back({top, n + i, n + k});
    }
    return out;
}

}  // namespace laboratory
