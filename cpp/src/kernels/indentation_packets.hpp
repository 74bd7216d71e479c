// Where the nodes of a packet stand before an indentation, which place of the post or edge they follow, and by how much. For
// files that are compiled once for each instruction set; see base/packet.hpp for what that forbids.
#pragma once

#include "base/packet.hpp"
#include "kernels/indentation_simd.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

// Least value that marks a node as following an indentation.
inline constexpr double least_drawn = 1e-9;

// Depth of the post's surface beyond its axis at `a` across, and its derivative.
struct Rise {
    Packet rise, across;
};
BIRM3D_INLINE Rise rise_at(const IndentationNumbers& d, const Packet& a) {
    const Packet zero = 0.0, steep_arc = d.steep_arc;
    const Packet far = where_above(zero, a, -1.0 * a, a);
    const Packet on = lesser(far, steep_arc);
    const Packet root = square_root(d.radius * d.radius - on * on);
    return {where_above(far, steep_arc, d.rise_there - steepest * (far - steep_arc), d.stretch * root),
            where_above(far, steep_arc, where_above(zero, a, steepest, -steepest), -d.stretch * a / root)};
}

// Positions of a packet of nodes in the post's axes, and the middle of the post at their heights.
struct Standing {
    Packet e, w, l, up, deepest;
};
BIRM3D_INLINE Standing stand(const IndentationNumbers& d, const PanelNodes& nodes, std::size_t i) {
    Standing s;
    const Packet rx = Packet::load(nodes.x + i) - d.ox, ry = Packet::load(nodes.y + i) - d.oy,
                 rz = Packet::load(nodes.z + i) - d.oz;
    s.e = d.ex * rx + d.ey * ry + d.ez * rz;
    s.w = d.wx * rx + d.wy * ry + d.wz * rz;
    s.l = d.lx * rx + d.ly * ry + d.lz * rz;
    s.up = lesser(s.l, d.top + d.top_slope * s.w);
    s.deepest = d.tilt * s.up + (d.stretch * d.radius + d.face_slope * s.w);
    return s;
}

// Lower bound of the gaps: the post is taken as deep everywhere as in its middle, with the least slope beside it.
BIRM3D_INLINE Packet no_less_than(const IndentationNumbers& d, const Standing& s) {
    const Packet zero = 0.0, by_depth = (s.deepest - d.surface) * d.per_reach;
    const Packet slope = lesser(lesser(greater(by_depth, least_slope), steepest), flattest_face(d));
    const Packet beside = greater(greater(s.w - d.most_w, d.least_w - s.w), zero);
    return s.e - (s.deepest - slope * (beside + (s.l - s.up)));
}

// The point of the post that each node of a packet follows.
struct FollowedPlace {
    Slope<Packet> slope;  // of the skin beside the post
    Packet a, at, beyond, gap;
    Packet on_face;  // across from that point, if the skin lies on a face of the edge; else 0
    // Above 0 if it does so and the panel does not reach as far on the other side, or if the panel ends before the edge.
    Packet alone;
    Rise rise;
};

// Of a face: the place of its top edge straight below each node.
BIRM3D_INLINE FollowedPlace follow_edge(const IndentationNumbers& d, const Standing& s) {
    FollowedPlace h;
    h.slope = slope_at<Packet>(s.deepest - d.surface, d.per_reach);
    h.a = s.w;
    h.rise = {0.0, 0.0};
    h.at = s.deepest;
    h.beyond = s.l - s.up;
    h.on_face = 0.0;
    h.alone = 0.0;
    h.gap = s.e - (h.at - h.slope.slope * h.beyond);
    return h;
}

// Slope of an edge's face on the side of each node.
BIRM3D_INLINE Packet slope_of_face(const IndentationNumbers& d, const Standing& s) {
    const Packet zero = 0.0;
    return where_above(s.w, zero, d.side_high.slope, d.side_low.slope);
}

BIRM3D_INLINE FollowedPlace find_followed(const IndentationNumbers& d, const Standing& s) {
    if (d.is_face) return follow_edge(d, s);
    FollowedPlace h;
    // Skin that would fall off more steeply than a face of the edge lies on the face.
    const Packet zero = 0.0, of_face = slope_of_face(d, s);
    const Slope<Packet> free = slope_at<Packet>(s.deepest - d.surface, d.per_reach);
    h.slope = {lesser(free.slope, of_face), where_above(free.slope, of_face, zero, free.grows)};
    const Packet low = d.low, high = d.high;
    // The nearest point of the post, within the panel, whose slope is not steeper than that of the indentation.
    const Packet slope_there = h.slope.slope * d.per_stretch;
    const Packet arc = d.radius * slope_there / square_root(1.0 + slope_there * slope_there);
    const Packet near = lesser(greater(s.w, -1.0 * arc), arc), highest = greater(s.w, high),
                 lowest = lesser(s.w, low);
    h.a = where_above(near, highest, highest, where_above(lowest, near, lowest, near));
    h.rise = rise_at(d, h.a);
    h.at = d.tilt * s.up + h.rise.rise;
    const Packet beside = where_above(s.w, h.a, s.w - h.a, h.a - s.w);
    h.beyond = beside + (s.l - s.up);
    const Packet other_side = where_above(s.w, zero, -1.0 * low, high);
    h.on_face = where_above(free.slope, of_face, beside, zero);
    h.alone = where_above(free.slope, of_face, beside - other_side, -1.0 * other_side);
    h.gap = s.e - (h.at - h.slope.slope * h.beyond);
    return h;
}

// Displacement along e of a following node for a unit displacement of the post inwards, and along the panel.
struct Drawn {
    Packet in, across;
    Packet by_turn;  // for each unit by which the slope of the face becomes less
};
BIRM3D_INLINE Drawn drawn(const IndentationNumbers& d, const FollowedPlace& h) {
    const Packet zero = 0.0, low = d.flank_low * d.grip, high = d.flank_high * d.grip;
    const Packet slope = h.slope.slope, flank = lesser(greater(h.rise.across, -1.0 * slope), slope);
    const Packet factor = where_above(h.a, zero, high, low);
    return {greater(d.grip * (1.0 - h.slope.grows * h.beyond), least_drawn),
            factor * flank / square_root(1.0 + flank * flank), d.grip * h.on_face};
}

// Outward displacement of nodes along e within the step (m): -du of kernels/indentation.hpp, by the trapezoid rule. `flatter`:
// by how much the slope of the edge's face has become less.
BIRM3D_INLINE Packet outward_displacement(const Standing& now, const Standing& then, const Drawn& at_end,
                                          const Drawn& at_start, const Packet& flatter) {
    const Packet zero = 0.0, in = (now.deepest - now.e) - (then.deepest - then.e), across = now.w - then.w;
    const Packet turn = where_above(lesser(at_end.by_turn, at_start.by_turn), zero, flatter, zero);
    return -0.5 * ((at_end.in + at_start.in) * in + (at_end.across + at_start.across) * across +
                   (at_end.by_turn + at_start.by_turn) * turn);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
