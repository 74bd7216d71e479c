// What the parts of the detection share.
#pragma once

#include "birm3d/kernels/detect.hpp"

namespace birm3d {

// A placement in plain numbers, and its way back for directions.
struct Turn {
    double xx, xy, xz, yx, yy, yz, zx, zy, zz;
    double x, y, z;
};

inline Turn turn_of(const Placement& p) {
    const Mat3& R = p.rotation;
    return {R(0, 0), R(0, 1), R(0, 2), R(1, 0),        R(1, 1),        R(1, 2),
            R(2, 0), R(2, 1), R(2, 2), p.position.x(), p.position.y(), p.position.z()};
}

// Nodes in the shape's own axes (m).
struct alignas(64) OwnLanes {
    Lanes x, y, z;
};

void to_own(const Turn& turn, const Lanes& x, const Lanes& y, const Lanes& z, OwnLanes& own);

// Of some values.
void extent(const Lanes& values, double& low, double& high);

// nearest_of, for a mesh.
void nearest_of_mesh(const TriangleMesh& mesh, const Placement& now, const Placement& before, const Lanes& x,
                     const Lanes& y, const Lanes& z, NearestLanes& out);

}  // namespace birm3d
