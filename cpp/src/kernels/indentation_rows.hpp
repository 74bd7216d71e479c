// The arithmetic of kernels/indentation on one block, compiled once for each instruction set (see base/row.hpp): columns as plain
// pointers, `block_size` numbers each.
#pragma once

#include "base/select.hpp"
#include "geometry/indentation_numbers.hpp"

namespace birm3d {

// Slope of a post's flank where a panel ends on it: beyond it small motions would make great forces.
inline constexpr double steepest = 5.0;

// Slope of an indentation that is no more than a touch. Less steep, a post beside a bowed front would draw in its middle.
inline constexpr double least_slope = 0.25;

// Of the post that has come `depth` in; `grows`: for each unit of it.
template <class Number>
struct Slope {
    Number slope, grows;
};
template <class Number>
BIRM3D_INLINE Slope<Number> slope_at(const Number& depth, double per_reach) {
    const Number zero = 0.0, limit = steepest;
    const Number by_depth = where_above(depth, zero, depth, zero) * per_reach;
    const Number slope = square_root(least_slope * least_slope + by_depth * by_depth);
    return {where_above(slope, limit, limit, slope),
            where_above(slope, limit, zero, by_depth * per_reach / slope)};
}

// Of a block, those of one panel.
struct PanelNodes {
    const double *x, *y, *z, *force, *panel;
    double of;
};

// What they have seen so far (NodeFaces, BlockContact); `rank`: the lower
// that is, the more right an indentation has to a node that pushes. `follows`: on this indentation (1; 2: let go by it; else 0).
struct SeenColumns {
    double *gap, *per_force, *bx, *by, *bz, *nx, *ny, *nz, *px, *py, *pz, *tx, *ty, *tz, *rank, *follows;
};

// See follow_indentation.
using FindIndentation = void (*)(const IndentationNumbers& indentation, const IndentationNumbers& then,
                                 const PanelNodes& nodes, const SeenColumns& seen);
// The least gap; infinite if there are no such nodes.
using FindIndentationGap = double (*)(const IndentationNumbers& indentation, const PanelNodes& nodes);

}  // namespace birm3d
