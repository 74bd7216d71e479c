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

// Nodes of the panel to which the dent is nearer than what they have seen so far hang on it, unless it would draw them
// into that: a post that came past the panel's edge stands behind them. Says in `faces` and `contact` how they do, and
// which (1, else 0). Of nodes that are outside and without force nothing may be said.
void hang_on(const Dent& dent, const Dent& then, const TrussBlockState& nodes, const Lanes& panel_of,
             std::size_t panel, NodeFaces& faces, BlockContact& contact, Lanes& rank, Lanes& hangs);

// No dent that is further from all nodes than this holds any of them (m). `gap`: of what they have seen so far.
double furthest_off(const TrussBlockState& nodes, const Lanes& panel_of, std::size_t panel, const Lanes& gap);

}  // namespace birm3d
