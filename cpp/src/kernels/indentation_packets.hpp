// Which place of a post or an edge the nodes of a packet follow, by how much, and how they push on it. For files that are compiled
// once for each instruction set; see base/packet.hpp for what that forbids.
//
// Symbols of kernels/indentation.hpp and their names here:
//   e, w, l   into the panel, across the post and along it         w*, f       FollowedPlace::w, FollowedPlace::e
//   s, ds/dd  Slope::slope, Slope::grows                           |w - w*|    FollowedPlace::beyond, with m (l - l*)+ added
//   q         slope_of_face()                                      e - D       FollowedPlace::gap
//   m, t, c   steeper, tilt, along_factor times tilt
//   g, g k    grip, and flank_low or flank_high times grip         -du         outward_displacement()
#pragma once

#include "base/packet.hpp"
#include "kernels/indentation_simd.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

// Least value that marks a node as following an indentation.
inline constexpr double least_drawn = 1e-9;

// Depth of the post's surface beyond its axis at `w` across, and its derivative.
struct Rise {
    Packet rise, by_w;
};
BIRM3D_INLINE Rise rise_at(const IndentationNumbers& indentation, const Packet& w) {
    const Packet zero = 0.0, steep_arc = indentation.steep_arc;
    const Packet far = where_above(zero, w, -1.0 * w, w);
    const Packet on = lesser(far, steep_arc);
    const Packet root = square_root(indentation.radius * indentation.radius - on * on);
    return {where_above(far, steep_arc, indentation.rise_there - steepest * (far - steep_arc),
                        indentation.stretch * root),
            where_above(far, steep_arc, where_above(zero, w, steepest, -steepest),
                        -indentation.stretch * w / root)};
}

// Where a packet of nodes is: into the panel (e), across the post (w) and along it (l), from its foot.
struct NodePlace {
    Packet e, w, l;
    Packet post_l;   // along, of the place of the post at the node's height: the top, for nodes above it
    Packet deepest;  // into, of the middle of the post there
    Packet
        overlap;  // height of the top above the panel's lower edge at the node; the panel meets the post where it is > 0
    Packet
        above;  // distance of the node beside the post that would draw it in as little as its height above the top
};
BIRM3D_INLINE NodePlace place_of(const IndentationNumbers& indentation, const PanelNodes& nodes,
                                 std::size_t i) {
    NodePlace place;
    const Packet rx = Packet::load(nodes.x + i) - indentation.ox,
                 ry = Packet::load(nodes.y + i) - indentation.oy,
                 rz = Packet::load(nodes.z + i) - indentation.oz;
    place.e = indentation.ex * rx + indentation.ey * ry + indentation.ez * rz + indentation.behind;
    place.w = indentation.wx * rx + indentation.wy * ry + indentation.wz * rz;
    place.l = indentation.lx * rx + indentation.ly * ry + indentation.lz * rz;
    place.post_l = lesser(place.l, indentation.top + indentation.top_slope * place.w);
    place.deepest = indentation.tilt * place.post_l +
                    (indentation.stretch * indentation.radius + indentation.face_slope * place.w);
    const Packet lower_edge = place.l - indentation.upward * Packet::load(nodes.height_above_edge + i);
    place.overlap =
        indentation.top + indentation.top_slope * place.w - lower_edge + indentation.edge_allowance;
    const Packet one = 1.0;
    place.above = indentation.steeper * greater(one, reach_above / place.overlap) * (place.l - place.post_l);
    return place;
}

// Lower bound of the gaps: the post is taken as deep everywhere as in its middle, with the least slope beside it.
BIRM3D_INLINE Packet no_less_than(const IndentationNumbers& indentation, const NodePlace& place) {
    const Packet zero = 0.0, by_depth = (place.deepest - indentation.surface) * indentation.per_reach;
    const Packet slope = lesser(lesser(greater(by_depth, least_slope), steepest), flattest_face(indentation));
    const Packet beside = greater(greater(place.w - indentation.most_w, indentation.least_w - place.w), zero);
    return place.e - (place.deepest - slope * (beside + place.above));
}

// The point of the post that each node of a packet follows.
struct FollowedPlace {
    Slope<Packet> slope;  // of the skin beside the post
    Packet e, w;          // of that point, into the panel and across
    Packet beyond;        // distance of the node beside and above that point
    Packet gap;
    Packet on_face;  // across from that point, if the skin lies on a face of the edge; else 0
    // Above 0 if it does so and the panel does not reach as far on the other side, or if the panel ends before the edge.
    Packet alone;
    Rise rise;
};

// Of a face: the place of its top edge straight below each node.
BIRM3D_INLINE FollowedPlace follow_edge(const IndentationNumbers& indentation, const NodePlace& place) {
    FollowedPlace followed;
    followed.slope = slope_at<Packet>(place.deepest - indentation.surface, indentation.per_reach);
    followed.w = place.w;
    followed.rise = {0.0, 0.0};
    followed.e = place.deepest;
    followed.beyond = place.above;
    followed.on_face = 0.0;
    followed.alone = 0.0;
    followed.gap = place.e - (followed.e - followed.slope.slope * followed.beyond);
    return followed;
}

// Slope of an edge's face on the side of each node.
BIRM3D_INLINE Packet slope_of_face(const IndentationNumbers& indentation, const NodePlace& place) {
    const Packet zero = 0.0;
    return where_above(place.w, zero, indentation.side_high.slope, indentation.side_low.slope);
}

BIRM3D_INLINE FollowedPlace find_followed(const IndentationNumbers& indentation, const NodePlace& place) {
    if (indentation.is_face) return follow_edge(indentation, place);
    FollowedPlace followed;
    // Skin that would fall off more steeply than a face of the edge lies on the face.
    const Packet zero = 0.0, of_face = slope_of_face(indentation, place);
    const Slope<Packet> free = slope_at<Packet>(place.deepest - indentation.surface, indentation.per_reach);
    followed.slope = {lesser(free.slope, of_face), where_above(free.slope, of_face, zero, free.grows)};
    const Packet low = indentation.low, high = indentation.high;
    // The nearest point of the post, within the panel, whose slope is not steeper than that of the indentation.
    const Packet slope_there = followed.slope.slope * indentation.per_stretch;
    const Packet arc = indentation.radius * slope_there / square_root(1.0 + slope_there * slope_there);
    const Packet near = lesser(greater(place.w, -1.0 * arc), arc), highest = greater(place.w, high),
                 lowest = lesser(place.w, low);
    followed.w = where_above(near, highest, highest, where_above(lowest, near, lowest, near));
    followed.rise = rise_at(indentation, followed.w);
    followed.e = indentation.tilt * place.post_l + followed.rise.rise;
    const Packet beside = where_above(place.w, followed.w, place.w - followed.w, followed.w - place.w);
    followed.beyond = beside + place.above;
    const Packet other_side = where_above(place.w, zero, -1.0 * low, high);
    followed.on_face = where_above(free.slope, of_face, beside, zero);
    followed.alone = where_above(free.slope, of_face, beside - other_side, -1.0 * other_side);
    followed.gap = place.e - (followed.e - followed.slope.slope * followed.beyond);
    return followed;
}

// Displacement along e of a following node for a unit displacement of the post inwards, and along the panel.
struct FollowingRate {
    Packet in, across;
    Packet by_turn;  // for each unit by which the slope of the face becomes less
};
BIRM3D_INLINE FollowingRate following_rate(const IndentationNumbers& indentation,
                                           const FollowedPlace& followed) {
    const Packet zero = 0.0, low = indentation.flank_low * indentation.grip,
                 high = indentation.flank_high * indentation.grip;
    const Packet slope = followed.slope.slope,
                 flank = lesser(greater(followed.rise.by_w, -1.0 * slope), slope);
    const Packet factor = where_above(followed.w, zero, high, low);
    return {greater(indentation.grip * (1.0 - followed.slope.grows * followed.beyond), least_drawn),
            factor * flank / square_root(1.0 + flank * flank), indentation.grip * followed.on_face};
}

// How much further a node is carried along e than on a frictionless wedge, for each unit that the post moves up along l. Above
// the top it is zero.
BIRM3D_INLINE Packet rate_held_along(const IndentationNumbers& post, const NodePlace& place,
                                     const FollowingRate& rate) {
    const Packet zero = 0.0;
    return where_above(place.l, place.post_l, zero, (1.0 - post.along_factor) * post.tilt * rate.in);
}

// Displacement along the panel within the step, of the place on the post before each node (m): as the foot moves and as the post
// turns in the plane of e and l.
BIRM3D_INLINE Packet slid_along(const IndentationNumbers& post, const IndentationNumbers& post_then,
                                const NodePlace& now, const NodePlace& then) {
    const double turn = (post.tilt - post_then.tilt) * post.per_stretch * post_then.per_stretch;
    return (then.l - now.l) - (0.5 * turn) * (now.deepest + then.deepest);
}

// Outward displacement of nodes along e within the step (m): -du of kernels/indentation.hpp, by the trapezoid rule. `flatter`:
// by how much the slope of the edge's face has become less.
BIRM3D_INLINE Packet outward_displacement(const IndentationNumbers& post, const IndentationNumbers& post_then,
                                          const NodePlace& now, const NodePlace& then,
                                          const FollowingRate& at_end, const FollowingRate& at_start,
                                          const Packet& flatter) {
    const Packet zero = 0.0, in = (now.deepest - now.e) - (then.deepest - then.e), across = now.w - then.w;
    const Packet turn = where_above(lesser(at_end.by_turn, at_start.by_turn), zero, flatter, zero);
    const Packet held = rate_held_along(post, now, at_end) + rate_held_along(post_then, then, at_start);
    return -0.5 * ((at_end.in + at_start.in) * in + held * slid_along(post, post_then, now, then) +
                   (at_end.across + at_start.across) * across + (at_end.by_turn + at_start.by_turn) * turn);
}

// Vectors in body axes, one for each node of a packet.
struct Vectors {
    Packet x, y, z;
};

// Vectors of parts into the panel (e), across the post (w) and along it (l).
BIRM3D_INLINE Vectors in_body_axes(const IndentationNumbers& indentation, const Packet& e, const Packet& w,
                                   const Packet& l) {
    return {e * indentation.ex + w * indentation.wx + l * indentation.lx,
            e * indentation.ey + w * indentation.wy + l * indentation.ly,
            e * indentation.ez + w * indentation.wz + l * indentation.lz};
}

// Displacement of nodes along e for a unit displacement of the post or the face by e, w and l. The push on the vehicle has this
// direction.
struct Push {
    Packet e, w, l;
};
BIRM3D_INLINE Push push_of(const IndentationNumbers& indentation, const NodePlace& place,
                           const FollowingRate& rate) {
    const Packet zero = 0.0, over = place.l - place.post_l;
    const Packet slope = where_above(over, zero, indentation.edge_slope, indentation.face_slope);
    return {rate.in, rate.across + slope * rate.in,
            where_above(over, zero, zero, rate.in * (indentation.along_factor * indentation.tilt))};
}

// Displacement of nodes along e for a unit rotation of the post about its foot: by its rotation about e, by the tilt of its axis
// along e, and by the rotation of an edge's face.
BIRM3D_INLINE Vectors turn_of_post(const IndentationNumbers& indentation, const NodePlace& place,
                                   const Push& push, const Packet& by_turn) {
    const Packet zero = 0.0, top = indentation.top;
    const Packet top_leans = indentation.top_rate * indentation.per_stretch;
    const double tilt = indentation.tilt, stretch = indentation.stretch;
    const EdgeSide &low = indentation.side_low, &high = indentation.side_high;
    const Packet about = push.l * place.w - push.w * place.l;
    const Packet one = 1.0, share = where_above(place.l, place.post_l, one, indentation.along_factor);
    const Packet leaning =
        push.e * (place.post_l + share * tilt * (tilt * place.post_l + stretch * indentation.radius) +
                  where_above(place.l, top, tilt * top_leans, zero));
    const Packet by_l = by_turn * where_above(place.w, zero, high.turn_l, low.turn_l),
                 by_w = leaning + by_turn * where_above(place.w, zero, high.turn_w, low.turn_w);
    return {about * (tilt * indentation.lx - indentation.ex) + by_w * indentation.wx + by_l * indentation.lx,
            about * (tilt * indentation.ly - indentation.ey) + by_w * indentation.wy + by_l * indentation.ly,
            about * (tilt * indentation.lz - indentation.ez) + by_w * indentation.wz + by_l * indentation.lz};
}

// The same for a rotation of the face: the place on the face times the direction of its push. By a rotation about e, or about l
// of a face that leans, the place below a node moves along the edge too.
BIRM3D_INLINE Vectors turn_of_face(const IndentationNumbers& indentation, const NodePlace& place,
                                   const FollowedPlace& followed, const Push& push) {
    const Packet below = (place.l - place.post_l) * push.w;
    const Packet e = place.post_l * push.w - place.w * push.l + below,
                 w = place.post_l * push.e + followed.e * push.l,
                 l = -1.0 * (followed.e * push.w + place.w * push.e + indentation.tilt * below);
    return in_body_axes(indentation, e, w, l);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
