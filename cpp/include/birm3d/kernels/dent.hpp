// A dent drags its surroundings along: beside a post the skin of a panel is drawn in with a slope s. Seen along the
// panel's direction e, into the vehicle, the post reaches to a depth f over the panel. Of a post that goes straight in the
// skin comes to
//   D(w, l) = max over places of the post that stand in the panel of  f(w*, l*) - s |w - w*| - s (l - l*)+
// with w across the post's axis and l along it, upwards. The slope grows with the depth d of the post,
// s = sqrt(s0^2 + (d / reach)^2): beams and panels carry a dent as far to either side when it is deep as when it is
// shallow.
//
// Sheet beside a post hangs on it by tension and shear. It goes in with the post, straight along e. It is not carried along
// the panel, so that a dent stays where it was made. Nor does it lean on the post's flank as a wedge, but for a share k.
// Once D has come to a node, its depth u follows the way v of the post:
//   du = g (1 - ds/dd |w - w*|) dv_e + g k sin(flank) dv_w
// with v_e of the post's deepest place at the node's height, and v_w across, from the node. A post whose axis is `off`
// beyond the panel's edge stands on that edge with its flank. What it pushes there goes in by the square of the flank's
// cosine: g = 1 - (off / radius)^2. So a load ends where a post is all beside the panel.
//
// The force on the vehicle follows by virtual work. Of a truss force F, with b from the node to its anchor, it is F (b . e)
// times the change of u with the post's place, and the torque that by its turn. Both ends of a step share its way, as the
// trapezoid rule shares the work on trusses. Skin that a post has gone to along the panel lags behind its flank: it is
// pushed aside, and its places across the panel are not followed.
//
// A node goes with the dent while its truss pushes, also behind a post that has gone on along the panel. Beyond the dent's
// reach it is let go, and what its truss stores is lost. Of several dents the deepest one holds a node. Skin slides on a
// post only along the panel: friction acts across e.
//
// A post as wide as the panel presses it as a wall does. f is that of the round post, cut off a hair above the highest
// place of its rim; where it falls off more steeply than `steepest`, with that slope.
//
// Not in the paper, whose trusses know nothing of each other: between them a narrow post passes, or free nodes slip
// round it to either side.
#pragma once

#include "birm3d/geometry/dent_numbers.hpp"
#include "birm3d/geometry/placement.hpp"
#include "birm3d/geometry/post.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/state/contacts.hpp"
#include "birm3d/state/truss_state.hpp"

namespace birm3d {

struct Dent : DentNumbers {
    Dent(const Post& post, const Placement& stands, const Panel& panel, double reach_);

    double reach;

    Vec3 into() const { return {ex, ey, ez}; }
    Vec3 across() const { return {wx, wy, wz}; }
    Vec3 along() const { return {lx, ly, lz}; }
    Vec3 foot() const { return {ox, oy, oz}; }

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

// Can nodes above or before the box, or in it, hang on the dent?
bool spans(const Dent& dent, const Box& box);

// Least gap of those nodes of a block that are of the panel (m); infinite if there are none.
double gap_of(const Dent& dent, const TrussBlockState& nodes, const Lanes& panel_of, std::size_t panel);

// Nodes of the panel that hang on the dent, or that it lets go, unless it would draw them into what they have seen so
// far: a post that came past the panel's edge stands behind them. Says in `faces` and `contact` how they do, and in
// `hangs` which (1; 2: let go; else 0). `then`: the dent an instant before. `rank`: of the dents that have the nodes, at first
// infinite. Of nodes that are outside and without force nothing may be said.
void hang_on(const Dent& dent, const Dent& then, const TrussBlockState& nodes, const Lanes& panel_of,
             std::size_t panel, NodeFaces& faces, BlockContact& contact, Lanes& rank, Lanes& hangs);

// No dent that is further from all nodes than this holds any of them (m). `gap`: of what they have seen so far.
double furthest_off(const TrussBlockState& nodes, const Lanes& panel_of, std::size_t panel, const Lanes& gap);

}  // namespace birm3d
