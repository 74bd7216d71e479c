// An indentation (kernels/indentation.hpp) in plain numbers, for files that are compiled for several instruction sets.
#pragma once

namespace birm3d {

// A post, or a face with a top edge, seen from a panel of the skin. Places from the foot of the post's axis or of the face:
// across it (w), along it (l) and into the panel (e); body axes, m.
struct IndentationNumbers {
    double ex, ey, ez, wx, wy, wz, lx, ly, lz;  // unit, square to each other
    double ox, oy, oz;                          // the foot
    double low, high;                           // of the panel, across from the axis
    double least_w, most_w;                     // of the post or the face, across
    double top;                                 // along, of the highest place of the rim, of a face at w = 0
    // Of a face for each unit of w; of a post zero: l of the top edge, e of the face and e of the edge.
    double top_slope = 0.0, face_slope = 0.0, edge_slope = 0.0;
    bool is_face = false;
    double top_rate;         // of `top`, for each unit of change of the axis's part along e
    double tilt;             // e of the axis for each unit of l
    double radius, stretch;  // the post's, and that of its section with a plane of e and w over it
    double surface;          // into, of the outermost node of the panel
    double per_reach, per_stretch;
    double
        grip;  // fraction of the post's displacement that the skin follows, at the deepest point of the post in the panel
    double flank_low, flank_high;  // factors of the flanks on either side, by w
    double wall_e, wall_w;         // of an edge: unit direction along its wall, by e and w; of a post zero
    double steep_arc, rise_there;  // across and deep, of the place from where the flank is steepest
};

}  // namespace birm3d
