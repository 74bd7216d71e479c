// The arithmetic of kernels/dent on one block, compiled once for each instruction set (see base/row.hpp): columns as plain
// pointers, `lanes` numbers each.
#pragma once

#include "birm3d/base/select.hpp"

namespace birm3d {

// A dent in plain numbers (see Dent), and the flank from where it is steepest.
struct DentNumbers {
    double ex, ey, ez, wx, wy, wz, lx, ly, lz, ox, oy, oz;
    double low, high, low_at, high_at, top, top_rate, tilt, radius, stretch, surface, per_reach, per_stretch;
    double steep_arc, rise_there;
};

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

// Which of the nodes matter: those of one panel that are inside or have a force, and have seen nothing nearer.
struct DentedNodes {
    const double* panel;
    double of;
    const double *force, *gap;  // gap: of what they have seen so far
};

struct DentColumns {
    double *gap, *nx, *ny, *nz, *per_force, *px, *py, *pz, *tx, *ty, *tz;
};

// What DentLanes says; the gap of a row of which no node matters is infinite, and nothing else is said of it.
using FindDent = void (*)(const DentNumbers& dent, const double* x, const double* y, const double* z,
                          const DentedNodes& nodes, const DentColumns& out);
// The least gap of those of the panel `of`; infinite if there are none.
using FindDentGap = double (*)(const DentNumbers& dent, const double* x, const double* y, const double* z,
                               const double* panel, double of);

}  // namespace birm3d
