// The arithmetic of kernels/indentation on one block, compiled once for each instruction set (see base/packet.hpp): columns as plain
// pointers, `block_size` numbers each.
#pragma once

#include "base/select.hpp"
#include "geometry/indentation_numbers.hpp"

namespace birm3d {

// Greatest slope of a post's flank that a panel follows: beyond it small motions would make large forces.
inline constexpr double steepest = 5.0;

// Slope of an indentation of depth zero. With a smaller slope, a post beside a bowed front would indent its middle.
inline constexpr double least_slope = 0.25;

// Slope beside a post at the depth `depth`; `grows`: its derivative by the depth.
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

// Does the face of an edge hold the skin itself, as a wall that is met head-on does? The skin never falls off less steeply.
BIRM3D_INLINE bool is_nearly_parallel(const EdgeFace& face) {
    return face.slope <= least_slope;
}

// Slope of the flattest face beside an edge; of a post more than the skin ever has.
BIRM3D_INLINE double flattest_face(const IndentationNumbers& indentation) {
    return indentation.side_low.slope < indentation.side_high.slope ? indentation.side_low.slope
                                                                    : indentation.side_high.slope;
}

// Nodes that are less than this below a top edge count as above it: the surface that is nearest to them may be the top (m).
inline constexpr double at_edge = 1e-6;

// Gap of released nodes: larger than that to any other surface (m).
inline constexpr double away = 10.0;

// The nodes of a block that are on one panel.
struct PanelNodes {
    const double *x, *y, *z, *force;
    const double* height_above_edge;  // see TrussBlock (m)
    const double* panel;
    double number;  // of the panel
};

// Their faces so far (NodeFaces, BlockContact). `rank`: of several indentations, that of lowest rank holds a pushing
// node. `follows`: 1 for nodes on this indentation, 2 for nodes that it releases, else 0.
struct KnownFaces {
    double *gap, *per_force, *bx, *by, *bz, *nx, *ny, *nz, *px, *py, *pz, *tx, *ty, *tz, *rank, *follows;
    // Of the surface that a node is in contact with: the gap, infinite without one (m); cosine of its normal and the panel's
    // direction above which it holds the node; 1 if the node was inside it as the step began, else 0.
    const double *contact_gap, *least_facing, *lags;
};

// See follow_indentation.
using FindIndentation = void (*)(const IndentationNumbers& indentation, const IndentationNumbers& then,
                                 const PanelNodes& nodes, const KnownFaces& known);
// The least gap; infinite if there are no such nodes.
using FindIndentationGap = double (*)(const IndentationNumbers& indentation, const PanelNodes& nodes);

}  // namespace birm3d
