// Declarations that the files detect_*.cpp share.
#pragma once

#include "kernels/detect.hpp"
#include "kernels/detect_simd.hpp"

namespace birm3d {

inline PlainPlacement plain_placement(const Placement& p) {
    const Mat3& R = p.rotation;
    return {R(0, 0), R(0, 1), R(0, 2), R(1, 0),        R(1, 1),        R(1, 2),
            R(2, 0), R(2, 1), R(2, 2), p.position.x(), p.position.y(), p.position.z()};
}

// Nodes in the shape's own axes (m).
struct alignas(64) OwnNodes {
    BlockColumn x, y, z;
};

// Returns their extent.
Extent to_own(const PlainPlacement& placed, const BlockColumn& x, const BlockColumn& y, const BlockColumn& z,
              OwnNodes& own);

// nearest_of, for a prism and for a mesh.
void nearest_of_prism(const Prism& prism, const Placement& now, const BlockColumn& x, const BlockColumn& y,
                      const BlockColumn& z, const BlockColumn* force, NearestOfBlock& out);
void nearest_of_mesh(const TriangleMesh& mesh, const Placement& now, const Placement& before,
                     const BlockColumn& x, const BlockColumn& y, const BlockColumn& z, NearestOfBlock& out);

}  // namespace birm3d
