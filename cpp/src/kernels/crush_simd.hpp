// The arithmetic of kernels/crush on one block, compiled once for each instruction set (see base/packet.hpp):
// columns as plain pointers, `block_size` numbers each.
#pragma once

#include <cstddef>

#include "base/node_sums.hpp"

namespace birm3d {

// Constant columns of a block.
struct PressColumns {
    const double *anchor_x, *anchor_y, *anchor_z, *length;  // m
    const double *k_unloading, *compliance;                 // N/m, m/N
    const double* recovery;  // m; null where no truss has one: all unload along lines of constant slope then
    const double*
        hinge;  // (hinges)(2)(block_size) deflection (m) and change of slope (N/m), one after the other
    std::size_t hinges;
    const double* factor;  // on the loading envelope; null where there is none
};

// The columns that a step changes.
template <class Number>
struct PressState {
    Number *x, *y, *z, *deflection, *force, *peak_deflection, *residual, *unloading;
};

// A flat surface n . p = offset, and the direction h in which it moves the nodes that were already on it.
struct FlatPress {
    double nx, ny, nz, offset;
    double hx, hy, hz;
};

// Cosine above which the normals at the start and at the end of the step belong to one surface.
inline constexpr double sharp_edge = 0.5;

// The same for surfaces of any shape, node by node.
struct CurvedPress {
    const double* gap;
    const double *nx, *ny, *nz;  // outward normal now, and of the same surface at the start of the step
    const double *bx, *by, *bz;
    // Above zero for nodes that follow an indentation. Then b is the direction of the displacement, and the normal
    // force is this times the truss force along b.
    const double* per_force;
    // Where friction acts, and the torque of a unit of normal force. Input for nodes that follow an indentation, else
    // output. Zero in packets of which no node pushes or pushed.
    double *px, *py, *pz, *tx, *ty, *tz;
    // Inverse effective mass of a node with torque t: mass + t . form t.
    double mass, xx, yy, zz, xy, xz, yz;
};

struct PressedNodes {
    double pushing = 0.0;  // how many nodes push
    bool ceased = false;   // has any node stopped pushing?
};

// Moves the nodes of a block that are at the surface onto it, finds the forces of their trusses and adds to the sums.
// Stores each node's gap before it was moved (m) and its normal force (N).
template <class Surface>
using Press = PressedNodes (*)(const PressColumns&, const Surface&, const PressState<const double>& before,
                               const PressState<double>& now, double* gap, double* normal_force,
                               NodeSums& sums);

}  // namespace birm3d
