// A post indents a panel and drags the skin beside it along: the skin is drawn in with a slope s beside the post. So does the top
// edge of a wall with the skin above it.
//
// The panel's direction e points into the vehicle; w is across the post's axis, l along it and upwards. Seen along e, the post
// reaches to a depth f over the panel. A post that goes straight in draws the skin in to the depth D:
//   D(w, l) = max of  f(w*, l*) - s |w - w*| - m s (l - l*)+
// The maximum is over the places (w*, l*) of the post in front of the panel. Above the post's top the skin falls off more
// steeply, by m = max(1, length / 0.2 m) max(1, 0.2 m / o). So a deep indentation reaches 0.2 m up, the height of bumpers and
// rails. It reaches up by no more than o, by which the panel overlaps the post from below. The
// slope grows with the depth d of the post, s = sqrt(s0^2 + (d / length)^2): beams and panels carry a deep
// indentation about as far to either side as a shallow one.
//
// The sheet beside a post is held by tension and shear. It goes in with the post, straight along e. It is not carried along
// the panel, so that an indentation stays where it was made. The factor k scales the sideways displacement by the flank. It is
// 0.35 for a post, chosen by hand: the sheet's tension on one flank balances a part of that on the other. On the open side of
// an edge that stands beside the rails it is edge_flank_factor. Before a face that is nearly parallel to the panel, that face
// holds the skin.
//
// Let a post lean by the slope t against the panel, as an upright one does where the front pitches. The push along the post is c
// times that into the panel:
//   c = max(t / sqrt(1 + (t / 0.35)^2), (t - 0.6) / (1 + 0.6 t))
// For t < 0 it is -c of -t. While t is small a front slides as on a wedge. Then it folds round the post, and climbs it with 0.35
// of its force. Beyond 49 degrees it slides up against a friction coefficient of 0.6. The edge of a wall that is met head-on is a
// wedge, c = t.
//
// Once D has reached a node, its depth u follows the velocity v of the post:
//   du = g r (dv_e - c dv_l) + g k sin(flank) dv_w
//   r  = 1 - ds/dd (|w - w*| + m (l - l*)+)
// v_e and v_l are those of the post's deepest place at the node's height; v_w is across the post, away from the node. Above the
// post's top v_e is the top's, and v_l does not count.
//
// A post whose axis is `off` beyond the panel's edge touches that edge with its flank. What it pushes there goes in by the square
// of the flank's cosine, g = 1 - (off / radius)^2. So a load ends where the whole post is beside the panel.
//
// An edge that stands obliquely before a panel has a face on either side, which falls off from the panel with the slope q. Where
// s exceeds q the skin lies on that face: q takes the place of s. Then u follows the turning of the face, too:
//   du = g dv_e - g |w - w*| dq
// Let the panel reach x beyond the edge on one side. On the other side skin up to x from the edge is held by tension, and goes
// straight in along e. Skin further away slides along the face, as along any surface.
//
// The force on the vehicle follows by virtual work. A truss force F with direction b, from the node to its anchor, gives
// F (b . e) times the derivative of u by the post's place, and the torque by its rotation. Both ends of a step share the
// post's displacement, as the trapezoid rule shares the work on trusses. Skin that a post has pushed aside lags behind its
// flank; its places across the panel are not followed.
//
// A node follows the indentation while its truss pushes, also behind a post that has moved on along the panel. Beyond the
// indentation's extent it is released, and what its truss stores is lost. A node that stands on another surface, as the ground,
// stays there. All nodes of a panel are released once the whole post is deeper than its anchors: a vehicle that scrapes past a
// post leaves it.
//
// Of several indentations the deepest one holds a node. An indentation does not release a node that stands on the flank of
// another post. Skin slides on a post only along the panel: friction acts across e.
//
// A panel's width and lower edge are those of its foremost nodes: up to one radius of the post deep, at least 0.2 m
// (least_outline_depth), which the rounded corner of a front has. A post that misses the bumper does not indent it by meeting
// the wider body behind: it meets the nodes there as any surface does. For the edge of a wall all nodes count, as the wall's
// face crushes what is deeper beside it. A post that comes past the panel's edge, deeper than the nodes there, does not indent the
// panel either. What decides is where it was as it passed the edge, whatever the length of steps.
//
// Between a front and a side is a rounded corner that neither outline has. A post that comes past a panel's edge there, no deeper than
// corner_depth, and moves into the panel (least_into_corner) does indent it. The indentation lags behind the post by the depth that the
// post had then, so that no node jumps: `behind` is added to e of each node. Deeper posts, posts that slide along a side and edges of
// walls do not indent the panel there.
//
// A post or a face draws in skin above its top only where the panel comes down to it. Below a node the panel ends at its lowest
// node there (heights_above_edge). If that is above the top, as a load bed's side is beside a low wall, nothing holds the node. A
// panel that rises above the top leaves the post or the face, as a vehicle does that pushes a post over.
//
// A vertical face with a top edge (top_edge.hpp) holds the skin before it, and draws in the skin above its top:
//   D(w, l) = E(w) - m s (l - top)+
// E is the place of the edge along e, a line that may be oblique to the panel. The skin goes in with the edge, straight along e,
// by du = (1 - m ds/dd (l - top)) dE. The force follows by virtual work, as that of a post. The skin does
// not slide over the edge as over a wedge. Skin that sinks below the edge while it hangs over it stays with the edge. Beside the
// face's ends nothing is drawn in; rounded edges there are posts.
//
// A post as wide as the panel acts as a wall does. The round post is cut off slightly above the highest place of its rim.
// Where f falls more steeply than `steepest`, it falls with that slope.
//
// This is an addition to the paper, whose trusses are independent of each other. Without it a narrow post passes between
// nodes, or free nodes slip round it to either side.
#pragma once

#include <algorithm>

#include "birm3d/geometry/post.hpp"
#include "birm3d/geometry/top_edge.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/state/contacts.hpp"
#include "birm3d/state/truss_state.hpp"
#include "geometry/indentation_numbers.hpp"
#include "geometry/placement.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

struct Indentation : IndentationNumbers {
    // `edge_flank_factor`: see Settings.
    Indentation(const Post& post, const Placement& stands, const Panel& panel, double length_,
                double edge_flank_factor);

    Indentation(const TopEdge& edge, const Placement& stands, const Panel& panel, double length_);

    double length;           // see with_indentation_length in Python (m)
    double bottom, ceiling;  // of the panel, along from the foot (m)

    Vec3 into() const { return {ex, ey, ez}; }
    Vec3 across() const { return {wx, wy, wz}; }
    Vec3 along() const { return {lx, ly, lz}; }
    Vec3 foot() const { return {ox, oy, oz}; }

    // Keeps the indentation behind the post by a constant distance (m).
    void stay_behind(double distance) { behind += distance, surface += distance; }

    // Distance of the post beside or below the panel (m). Negative if part of the post is in front of, in or behind
    // the panel.
    double beside() const;

    // Distance across the post between it and the panel (m). Negative if they overlap across, though the post may be below.
    double beside_across() const { return std::max(low - most_w, least_w - high); }

    // Of the post over the panel, along `into` from the foot (m).
    double deepest_place(const Panel& panel) const;

    // Is the whole post behind the panel, even if that is fully crushed?
    bool is_beyond(const Panel& panel) const;

    // Greatest speed of the indentation at any node while the post approaches with 1 m/s. It moves less along itself.
    double fastest_growth(const Panel& panel) const;

  private:
    void set_axes(const Vec3& foot, const Vec3& axis_up, const Panel& panel);
    void set_outline(const Box& outline);
    void set_faces(const Post& post, const Placement& stands);
};

// The same obstacle and panel at a fraction of the motion from one place to another.
Indentation between(const Indentation& one, const Indentation& other, double fraction);

// Beside and along the panel as in `place`, and as deep in it as `other`, of the same obstacle and panel.
Indentation as_deep_as(const Indentation& place, const Indentation& other);

// Does the panel come towards the foot of an obstacle, whose own motion is left out? `motion`: of the panel's body, body axes. `least`: cosine of
// the panel's outward direction and its velocity there, which is exceeded.
bool comes_towards(const Panel& panel, const Placement& stands, const Twist& motion, double least);

// Is the post upright enough before the panel to indent it? If it is an edge, does one of its faces point at the panel?
// `motion`: of the panel's body, body axes. `indents`: does the post do so already?
bool can_indent(const Post& post, const Placement& stands, const Panel& panel, const Twist& motion,
                bool indents);
// Is the face upright enough before the panel, and does it point at it?
bool can_indent(const TopEdge& edge, const Placement& stands, const Panel& panel, bool indents);

// Upper bound of the depth of all nodes of the box (body axes) in the indentation (m). Negative if none is reached.
// `hangs`: does any of them follow a top edge? It may have sunk below the edge.
double most_inside(const Indentation& indentation, const Box& box, bool hangs = false);

// Can nodes above or before the box, or in it, follow the indentation?
bool spans(const Indentation& indentation, const Box& box, bool hangs = false);

// Least gap of the nodes of a block that are on the panel (m); infinite if there are none.
double gap_of(const Indentation& indentation, const TrussBlockState& nodes, const TrussBlock& trusses,
              std::size_t panel);

// Finds the nodes of the panel that follow the indentation or that it releases, and sets their `faces` and `contact`.
// A node that would be drawn into another surface does not follow: the post came past the panel's edge behind it.
// `then`: the indentation at the start of the step. `follows`: 1 for nodes that follow, 2 for released ones, else 0.
// `contact_gap`: to the surface in `faces`, of nodes that are in contact with it as the kernel is called; else infinite (m).
// `least_facing`: cosine of that surface's normal and the panel's direction above which it holds the node.
// `lags`: 1 for nodes that were inside that surface as the step began, if a wall's edge indents the block; else 0. Below a
// top edge also for nodes that do not push; beside an upright edge these are free.
// `rank`: of the indentation that each node follows so far, at first infinite. Free nodes outside may be left
// unchanged.
void follow_indentation(const Indentation& indentation, const Indentation& then, const TrussBlockState& nodes,
                        const TrussBlock& trusses, std::size_t panel, const BlockColumn& contact_gap,
                        const BlockColumn& least_facing, const BlockColumn& lags, NodeFaces& faces,
                        BlockContact& contact, BlockColumn& rank, BlockColumn& follows);

// An indentation that is further than this from all nodes holds none of them (m). `gap`: to the nearest surface so
// far.
double furthest_off(const TrussBlockState& nodes, const BlockColumn& panel_of, std::size_t panel,
                    const BlockColumn& gap);

}  // namespace birm3d
