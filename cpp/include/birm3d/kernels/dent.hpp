// A dent drags its surroundings along: beside a post the skin of a panel is drawn in with a slope s. Seen along the
// panel's direction e, into the vehicle, the post reaches to a depth f over the panel; the skin to
//   D(w, l) = max over places of the post that stand in the panel of  f(w*, l*) - s |w - w*| - s (l - l*)+
// with w across the post's axis and l along it, upwards. A node goes straight along e, as at a wall, to e . x = D. Its
// depth is a function of how the post stands alone, whatever came before, so that the force on the vehicle follows by
// virtual work: of a truss force F, with b from the node to its anchor,
//   F (b . e) (e - f_w w - f_l l),
// the normal of the post where it drives the node, with the torque by which D changes as the post turns: at the post
// itself that of a force there; beside it the dent turns about e with the post.
// A post as wide as the panel presses it as a wall does.
//
// The slope grows with the depth d of the post, s = sqrt(s0^2 + (d / reach)^2): beams and panels carry a dent as far to
// either side when it is deep as when it is shallow. What a node has to go less for that is part of its virtual work.
//
// f is that of the round post, cut off a hair above the highest place of its rim; where it falls off more steeply than
// `steepest`, which is asked only of a post that has come half across the panel's edge, with that slope.
//
// Not in the paper, whose trusses know nothing of each other: between them a narrow post passes, or free nodes slip
// round it to either side.
#pragma once

#include "birm3d/geometry/placement.hpp"
#include "birm3d/geometry/post.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/state/truss_state.hpp"

namespace birm3d {

// A post seen from a panel. Places from the foot of its axis: across it (w), along it (l) and into the panel (e); m.
struct Dent {
    Dent(const Post& post, const Placement& stands, const Panel& panel, double reach);

    Vec3 into, across, along;  // e, w, l: unit, square to each other, body axes
    Vec3 foot;                 // of the axis, body axes
    double low, high;          // of the panel, across from the axis
    double low_at, high_at;    // along from the foot, of the middles of these edges
    double top;                // along, of the highest place of the rim
    double top_rate;           // of that for each unit of change of the axis's part along e
    double tilt;               // e of the axis for each unit of l
    double radius, stretch;    // the post's, and that of its section with a plane of e and w over it
    double surface;            // into, of the outermost node of the panel
    double reach;

    // How far the post stands beside the panel, or ends below it (m); negative: some of it stands before, in or behind it.
    double beside(const Panel& panel) const;

    // Does the post stand wholly behind the panel, however crushed that is?
    bool is_beyond(const Panel& panel) const;

    // How fast it can grow at any node while the post comes with 1 m/s.
    double fastest_growth(const Panel& panel) const;
};

// Does the post stand upright enough before the panel for a dent? `dents`: does it make one already?
bool stands_across(const Placement& post, const Panel& panel, bool dents);

// No node of the box (body axes) is further inside than this (m); negative: none is reached.
double most_inside(const Dent& dent, const Box& box);

struct alignas(64) DentLanes {
    Lanes gap;         // along e; negative inside (m)
    Lanes nx, ny, nz;  // outward normal of the post where it drives the node
    Lanes per_force;   // normal force for each unit of the truss force along e
    Lanes px, py, pz;  // where it drives the node, body axes (m)
    Lanes tx, ty, tz;  // torque on the body for each unit of normal force, about its mass centre (m)
};

// Least gap of those nodes of a block that are of the panel (m); infinite if there are none.
double gap_of(const Dent& dent, const TrussBlockState& nodes, const Lanes& panel_of, std::size_t panel);

// Nodes of one panel, and gaps of what they have seen so far.
struct OfPanel {
    const Lanes& panel_of;  // of each node
    std::size_t panel;
    const Lanes& gap;  // m
};

// Also how they hang on it, of those that the dent may hold: of nodes of another panel, of those that are outside and
// without force, and of those that have seen something nearer the gap may be infinite, and then nothing else is said.
void dent_of(const Dent& dent, const TrussBlockState& nodes, const OfPanel& of, DentLanes& out);

// No dent that is further from all nodes than this holds any of them (m).
double furthest_off(const TrussBlockState& nodes, const OfPanel& of);

}  // namespace birm3d
