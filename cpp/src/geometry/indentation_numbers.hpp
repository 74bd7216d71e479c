// An indentation (kernels/indentation.hpp) in plain numbers, for files that are compiled for several instruction sets.
#pragma once

namespace birm3d {

// How far above the top of a post or a wall a deep indentation draws in the skin (m). That is no further than the panel overlaps
// it from below. Bumpers and rails are 0.15 to 0.25 m high: what loads their lower edge loads them whole, and nothing as stiff ties
// them to what is above. No test has measured it.
inline constexpr double reach_above = 0.2;

// One of the two faces of an edge, seen from a panel: its unit direction from the edge, by e and w. By `slope` it falls off from
// the panel, for each unit of w.
struct EdgeFace {
    double e, w, slope;
};

// Beside an edge: the slope of the face on which skin can lie; without such a face more than the skin ever has. By rotations
// about l and w the slope becomes less by `turn_l` and `turn_w` (1/rad).
struct EdgeSide {
    double slope = 1e3, turn_l = 0.0, turn_w = 0.0;
};

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
    double steeper;   // slope of the skin above the top, over that beside the post
    double top_rate;  // of `top`, for each unit of change of the axis's part along e
    double upward;    // l of the body's upward axis
    // Added to the overlap of post and panel in height: zero, or a great length where the vehicle is tilted so far that the
    // panel has no lower edge (m).
    double edge_allowance;
    double tilt;             // e of the axis for each unit of l
    double radius, stretch;  // the post's, and that of its section with a plane of e and w over it
    double behind = 0.0;     // how far the indentation stays behind the post, along e
    double surface;          // into, of the outermost node of the panel, with `behind` added
    double per_reach, per_stretch;
    double
        grip;  // fraction of the post's displacement that the skin follows, at the deepest point of the post in the panel
    double flank_low, flank_high;  // factors of the flanks on either side, by w
    double along_factor;           // c over t of kernels/indentation.hpp
    EdgeFace face[2] = {};         // of an edge; of a post zero
    EdgeSide side_low, side_high;  // by w
    double steep_arc, rise_there;  // across and deep, of the place from where the flank is steepest
};

}  // namespace birm3d
