// The arithmetic of kernels/dent on one block, compiled once for each instruction set (see base/row.hpp): columns as plain
// pointers, `lanes` numbers each.
#pragma once

#include "birm3d/base/select.hpp"
#include "birm3d/geometry/dent_numbers.hpp"

namespace birm3d {

// Slope of a post's flank where a panel ends on it: beyond it small motions would make great forces.
inline constexpr double steepest = 5.0;

// Slope of a dent that is no more than a touch. Less steep, a post beside a bowed front would draw in its middle.
inline constexpr double least_slope = 0.25;

// Of the post that has come `depth` in; `grows`: for each unit of it.
template <class Number>
struct Slope {
    Number slope, grows;
};
template <class Number>
BIRM3D_IN_LANE_LOOP Slope<Number> slope_at(const Number& depth, double per_reach) {
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
// that is, the more right a dent has to a node that pushes. `hangs`: on this dent (1; 2: let go by it; else 0).
struct SeenColumns {
    double *gap, *per_force, *bx, *by, *bz, *nx, *ny, *nz, *px, *py, *pz, *tx, *ty, *tz, *rank, *hangs;
};

// See hang_on.
using FindDent = void (*)(const DentNumbers& dent, const DentNumbers& then, const PanelNodes& nodes,
                          const SeenColumns& seen);
// The least gap; infinite if there are no such nodes.
using FindDentGap = double (*)(const DentNumbers& dent, const PanelNodes& nodes);

}  // namespace birm3d
