// The data of a TriangleMesh, prepared once.
#pragma once

#include <vector>

#include "birm3d/geometry/triangle_mesh.hpp"
#include "geometry/triangle.hpp"
#include "geometry/triangle_tree.hpp"

namespace birm3d {

struct TriangleMeshData {
    std::vector<Triangle> triangles;
    TriangleTree tree;
    bool closed = false;
    double thickness = 0.0;  // m
};

// Signed distance and normal at `p`, whose nearest point lies on a part of a triangle. `on`: the vector from there to
// p.
Nearest nearest_from(const Triangle& triangle, const OnTriangle& on, const Vec3& p);

// Checks the arguments of TriangleMesh and gives triangles with their neighbourhood.
std::vector<Triangle> triangles_of(const std::vector<Vec3>& vertices,
                                   const std::vector<TriangleMesh::Face>& faces, bool& closed);

}  // namespace birm3d
