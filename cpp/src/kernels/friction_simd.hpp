// The arithmetic of kernels/friction on one block, compiled once for each instruction set (see base/packet.hpp): columns as
// plain pointers, `block_size` numbers each.
#pragma once

namespace birm3d {

// mu, the speed of full friction (m/s), and the twist of the vehicle (m/s, rad/s).
struct Sliding {
    double mu, full_speed;
    double vx, vy, vz, wx, wy, wz;
};

// Places, outward normals of the surface there and normal forces.
struct SlidingNodes {
    const double *x, *y, *z, *nx, *ny, *nz, *normal_force;
};

// `slow`: does any node slide slowly?
struct FrictionSums {
    double fx, fy, fz, tx, ty, tz;
    bool slow;
};

// Sums of q P, q [r] P and -q [r] P [r], P = 1 - n n^T.
struct ResistanceSums {
    double xx, xy, xz, yy, yz, zz;
    double rxx, rxy, rxz, ryx, ryy, ryz, rzx, rzy, rzz;
    double rrxx, rrxy, rrxz, rryy, rryz, rrzz;
};

// Sums of q, q r and q r r^T.
struct Moments {
    double q, x, y, z, xx, yy, zz, xy, xz, yz;
};

// Also q, the force for each unit of sliding velocity, of nodes that slide slowly; else zero.
using FindFriction = FrictionSums (*)(const Sliding&, const SlidingNodes&, double* q);
using FindResistance = ResistanceSums (*)(const double* q, const SlidingNodes&);
using FindMoments = Moments (*)(const double* q, const SlidingNodes&);

}  // namespace birm3d
