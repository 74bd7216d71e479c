// One triangle of a mesh and the point of it that is nearest to another point.
#pragma once

#include <array>
#include <cstddef>

#include "birm3d/base/types.hpp"
#include "geometry/triangle_nearest.hpp"

namespace birm3d {

// The surface around a part of a triangle: flat, bent, or the rim of an open mesh.
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
    PlainTriangle plain;
};

double area_of(const Vec3& a, const Vec3& b, const Vec3& c);  // paper Eq. 15

// Does a point of the triangle's plane lie within it? (paper 5.1)
bool holds(const Triangle& t, const Vec3& p);

// Of the corners alone.
PlainTriangle plain_triangle(const std::array<Vec3, 3>& corner);

OnTriangle nearest_on(const Triangle& t, const Vec3& p);

}  // namespace birm3d
