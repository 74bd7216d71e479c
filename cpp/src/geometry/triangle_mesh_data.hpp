// What a TriangleMesh is made of, prepared once.
#pragma once

#include <vector>

#include "birm3d/geometry/triangle_mesh.hpp"
#include "triangle.hpp"
#include "triangle_tree.hpp"

namespace birm3d {

struct TriangleMeshData {
    std::vector<Triangle> triangles;
    TriangleTree tree;
    bool closed = false;
    double thickness = 0.0;  // m
};

// Checks the arguments of TriangleMesh and gives triangles with their neighbourhood.
std::vector<Triangle> triangles_of(const std::vector<Vec3>& vertices,
                                   const std::vector<TriangleMesh::Face>& faces, bool& closed);

}  // namespace birm3d
