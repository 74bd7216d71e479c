// The arithmetic of kernels/detect on one block, compiled once for each instruction set (see base/packet.hpp): columns as
// plain pointers, `block_size` numbers each.
#pragma once

#include <cstddef>

#include "geometry/prism_nearest.hpp"

namespace birm3d {

// A placement (geometry/placement.hpp) in plain numbers.
struct PlainPlacement {
    double xx, xy, xz, yx, yy, yz, zx, zy, zz;
    double x, y, z;
};

struct Points {
    const double *x, *y, *z;
};

struct Columns {
    double *x, *y, *z;
};

// Least and greatest coordinates of some points.
struct Extent {
    double low[3], high[3];
};

struct EdgeList {
    const PrismEdge* edge = nullptr;
    std::size_t count = 0;
};

// The edges of a prism that matter for the nodes of a block.
struct PrismView {
    EdgeList faces, covered;                // of those that can be the nearest
    EdgeList splitting, covered_splitting;  // of those that a line from a node along +x may cross or not
    double side = 1.0;                      // of the nodes, once the line has crossed all others; +1 outside
    double y_low, y_high;                   // m
    bool low_end, high_end;                 // are they surfaces, and near?
    const double* force;                    // see nearest_of(); null: gaps of all nodes are needed
};

// Nodes in the axes of a shape, and their extent.
using PlaceNodes = void (*)(const PlainPlacement& placed, const Points& nodes, const Columns& own,
                            Extent& extent);
using FindExtent = void (*)(const Points& nodes, Extent& extent);
// Gaps of nodes `own`, which are in the prism's axes, and their normals in body axes.
using AskPrism = void (*)(const PrismView& prism, const PlainPlacement& placed, const Points& own,
                          double* gap, const Columns& normals);

}  // namespace birm3d
