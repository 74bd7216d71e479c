// One triangle of a mesh and the point of it that is nearest to another point.
#pragma once

#include <array>
#include <cstddef>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/base/types.hpp"

namespace birm3d {

// Parts of a triangle: itself, the edges from corner i to i + 1, the corners.
enum TrianglePart : std::size_t { inner = 0, edge_0 = 1, corner_0 = 4, part_count = 7 };

// What the surface is like around a part.
enum class Vicinity { flat, bent, rim };

struct Triangle {
    std::array<Vec3, 3> corner;  // m
    std::array<std::size_t, 3> vertex;
    std::size_t face;  // of the flat faces of the mesh
    double area;       // m^2
    // The plane of the flat face: normal . p = offset.
    Vec3 normal;
    double offset;  // m
    std::array<Vec3, part_count> pseudo_normal;
    std::array<Vicinity, part_count> vicinity;
};

inline double area_of(const Vec3& a, const Vec3& b, const Vec3& c) {  // paper Eq. 15
    return 0.5 * (b - a).cross(c - b).norm();
}

// Does a point of the triangle's plane lie within it? (paper 5.1)
inline bool holds(const Triangle& t, const Vec3& p) {
    const double parts = area_of(t.corner[0], t.corner[1], p) + area_of(t.corner[1], t.corner[2], p) +
                         area_of(t.corner[2], t.corner[0], p);
    return parts <= (1.0 + tolerance::triangle_area) * t.area;
}

struct OnTriangle {
    Vec3 point;
    std::size_t part;  // that it lies on
};

// By the regions in which a corner, an edge or the inside is nearest (C. Ericson, Real-Time Collision
// Detection, 2005, section 5.1.5).
OnTriangle nearest_on(const Triangle& t, const Vec3& p);

}  // namespace birm3d
