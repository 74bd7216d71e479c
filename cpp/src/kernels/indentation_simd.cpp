// Compiled once for each instruction set; see base/packet.hpp for what that forbids.
#include "kernels/indentation_simd.hpp"

#include "base/packet.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

// Least value that marks a node as following an indentation.
constexpr double least_drawn = 1e-9;

// A node that was further inside a face than this as the step began is not held by it (m).
constexpr double least_lag = 1e-8;

// The face of a wall holds a node that pushes beside its edge if it is no further away: more than a step's motion (m).
constexpr double in_reach = 0.01;

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
    const Packet slope = lesser(greater(by_depth, least_slope), steepest);
    const Packet beside = greater(greater(s.w - d.most_w, d.least_w - s.w), zero);
    return s.e - (s.deepest - slope * (beside + (s.l - s.up)));
}

// `yes` for nodes that are further along the wall than the axis of its edge, so that the wall's face holds them, else `no`.
// A node that lags inside the face stays with the edge. The face would move it in one step, and the energy would jump.
BIRM3D_INLINE Packet where_beside_face(const IndentationNumbers& d, const KnownFaces& known,
                                       const Standing& s, const Packet& yes, const Packet& no,
                                       std::size_t i) {
    const Packet zero = 0.0, along = d.wall_e * (s.e - d.tilt * s.up) + d.wall_w * s.w;
    return where_above(Packet::load(known.lags + i), zero, no, where_above(along, zero, yes, no));
}

// The point of the post that each node of a packet follows.
struct FollowedPlace {
    Slope<Packet> slope;  // of the skin beside the post
    Packet a, at, beyond, gap;
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
    h.gap = s.e - (h.at - h.slope.slope * h.beyond);
    return h;
}

BIRM3D_INLINE FollowedPlace find_followed(const IndentationNumbers& d, const Standing& s) {
    if (d.is_face) return follow_edge(d, s);
    FollowedPlace h;
    h.slope = slope_at<Packet>(s.deepest - d.surface, d.per_reach);
    const Packet low = d.low, high = d.high;
    // The nearest point of the post, within the panel, whose slope is not steeper than that of the indentation.
    const Packet slope_there = h.slope.slope * d.per_stretch;
    const Packet arc = d.radius * slope_there / square_root(1.0 + slope_there * slope_there);
    const Packet near = lesser(greater(s.w, -1.0 * arc), arc), highest = greater(s.w, high),
                 lowest = lesser(s.w, low);
    h.a = where_above(near, highest, highest, where_above(lowest, near, lowest, near));
    h.rise = rise_at(d, h.a);
    h.at = d.tilt * s.up + h.rise.rise;
    h.beyond = where_above(s.w, h.a, s.w - h.a, h.a - s.w) + (s.l - s.up);
    h.gap = s.e - (h.at - h.slope.slope * h.beyond);
    return h;
}

// `yes` for nodes that the post or the top edge can draw in, else `no`. Below its top edge a face holds the skin itself, apart
// from nodes that sank below the edge: they lag behind the face. `lag`: by how much (m).
BIRM3D_INLINE Packet where_drawn(const IndentationNumbers& d, const Standing& s, const Packet& lag,
                                 const Packet& yes, const Packet& no) {
    if (!d.is_face) return yes;
    const Packet zero = 0.0, one = 1.0, most = d.most_w, least = d.least_w;
    const Packet rise = s.l - (d.top + d.top_slope * s.w) + at_edge;
    const Packet above = greater(rise, lag - least_lag);
    const Packet within = where_above(s.w, most, zero, where_above(least, s.w, zero, one));
    return where_above(lesser(above, within), zero, yes, no);
}

// `yes` for nodes of the panel, else `no`.
BIRM3D_INLINE Packet where_on(const PanelNodes& nodes, const Packet& yes, const Packet& no, std::size_t i) {
    const Packet zero = 0.0, off = Packet::load(nodes.panel + i) - nodes.number;
    return where_above(off * off, zero, no, yes);
}

// Can the indentation affect any node, given a lower bound of the gaps?
BIRM3D_INLINE bool any_matters(const PanelNodes& nodes, const KnownFaces& known, const Packet& least,
                               std::size_t i) {
    const Packet zero = 0.0;
    const Packet so_far = Packet::load(known.gap + i);
    const Packet holds = greater(Packet::load(nodes.force + i), Packet::load(known.lags + i));
    const Packet below = where_above(holds, zero, infinitely_far, lesser(so_far, zero));
    return any_above(where_on(nodes, below, -infinitely_far, i), least);
}

// Displacement along e of a following node for a unit displacement of the post inwards, and along the panel.
struct Drawn {
    Packet in, across;
};
BIRM3D_INLINE Drawn drawn(const IndentationNumbers& d, const FollowedPlace& h) {
    const Packet zero = 0.0, low = d.flank_low * d.grip, high = d.flank_high * d.grip;
    const Packet slope = h.slope.slope, flank = lesser(greater(h.rise.across, -1.0 * slope), slope);
    const Packet factor = where_above(h.a, zero, high, low);
    return {greater(d.grip * (1.0 - h.slope.grows * h.beyond), least_drawn),
            factor * flank / square_root(1.0 + flank * flank)};
}

// Outward displacement of the nodes within the step.
BIRM3D_INLINE Packet outward_displacement(const Standing& now, const Standing& then, const Drawn& at_end,
                                          const Drawn& at_start) {
    const Packet in = (now.deepest - now.e) - (then.deepest - then.e), across = now.w - then.w;
    return -0.5 * ((at_end.in + at_start.in) * in + (at_end.across + at_start.across) * across);
}

// Gap to another surface that stops the node from following the indentation. It is infinite where no surface does.
BIRM3D_INLINE Packet gap_of_holding_surface(const IndentationNumbers& d, const KnownFaces& known,
                                            std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far, faces = Packet::load(known.least_facing + i);
    const Packet along = d.ex * Packet::load(known.nx + i) + d.ey * Packet::load(known.ny + i) +
                         d.ez * Packet::load(known.nz + i);
    const Packet gap = where_above(along, faces, Packet::load(known.contact_gap + i), far);
    return where_above(Packet::load(known.per_force + i), zero, far, gap);
}

// Required gap of each node. A loaded node follows the indentation while that extends over it, and is released afterwards.
// An unloaded one follows once the indentation has reached it.
struct Asked {
    Packet gap, releases, rank;
};
BIRM3D_INLINE Asked ask(const IndentationNumbers& d, const PanelNodes& nodes, const KnownFaces& known,
                        const Standing& s, const FollowedPlace& h, const Packet& outward, std::size_t i) {
    const Packet zero = 0.0, one = 1.0, far = infinitely_far, surface = d.surface;
    const Packet pushes = Packet::load(nodes.force + i), holds = d.grip > 0.0 ? one : zero;
    const Packet comes = where_above(h.gap, zero, h.gap, greater(h.gap, outward));
    // A node on another surface follows the indentation only once that has reached it.
    const Packet other = where_above(far, gap_of_holding_surface(d, known, i), far, outward);
    const Packet goes = where_above(zero, h.gap, outward, other);
    const Packet reaches =
        where_above(s.e - h.gap, surface, where_beside_face(d, known, s, zero, holds, i), zero);
    const Packet off = where_above(pushes, zero, where_above(reaches, zero, zero, one), zero);
    const Packet gap = where_above(pushes, zero, where_above(reaches, zero, goes, away),
                                   where_beside_face(d, known, s, far, comes, i));
    return {gap, off, where_above(off, zero, away, where_above(far, gap, h.gap, far))};
}

// State of the nodes in this indentation: 1 for those that follow it, 2 for those that it releases, else 0. Of
// several indentations the deepest one at the node governs. A choice by displacements would alternate from step to
// step.
BIRM3D_INLINE Packet find_state(const IndentationNumbers& d, const PanelNodes& nodes, const KnownFaces& known,
                                const Standing& s, const Standing& was, const Asked& asked, std::size_t i) {
    const Packet zero = 0.0, one = 1.0, so_far = Packet::load(known.gap + i), gap = asked.gap;
    const Packet against = d.ex * Packet::load(known.nx + i) + d.ey * Packet::load(known.ny + i) +
                           d.ez * Packet::load(known.nz + i);
    const Packet state = one + asked.releases;
    const Packet drawn_in = where_above(zero, so_far - against * gap, zero, state);
    const Packet lags = Packet::load(known.lags + i);
    const Packet nearer = where_above(lags, zero, state, where_above(zero, against, drawn_in, state));
    const Packet pushes = Packet::load(nodes.force + i), by_surface = gap_of_holding_surface(d, known, i);
    const Packet by_indentation =
        where_above(Packet::load(known.per_force + i), zero, Packet::load(known.rank + i), by_surface);
    const Packet near = in_reach, far = infinitely_far, by_face = where_above(so_far, near, far, so_far);
    const Packet free_last = where_above(lags, zero, by_indentation, so_far);
    const Packet last =
        where_above(pushes, zero, where_beside_face(d, known, s, by_face, by_indentation, i), free_last);
    const Packet now = where_above(pushes, zero, asked.rank, gap);
    const Packet lag = where_above(greater(pushes, lags), zero, was.deepest - was.e, zero);
    const Packet found = where_drawn(d, s, lag, where_above(last, now, nearer, zero), zero);
    return where_on(nodes, found, zero, i);
}

// Displacement of nodes, as a vector in body axes, for a unit rotation of the post or the face about its foot.
struct Turn {
    Packet x, y, z;
};

// By rotation of the post about e, and by tilt of its axis along e.
BIRM3D_INLINE Turn turn_of_post(const IndentationNumbers& d, const Standing& n, const Packet& fe,
                                const Packet& fw, const Packet& fl) {
    const Packet zero = 0.0, top = d.top, top_leans = d.top_rate * d.per_stretch;
    const Packet about = fl * n.w - fw * n.l;
    const Packet leaning = fe * (d.stretch * d.stretch * n.up + d.stretch * d.tilt * d.radius +
                                 where_above(n.l, top, d.tilt * top_leans, zero));
    return {about * (d.tilt * d.lx - d.ex) + leaning * d.wx, about * (d.tilt * d.ly - d.ey) + leaning * d.wy,
            about * (d.tilt * d.lz - d.ez) + leaning * d.wz};
}

// The place on the face times the direction of its push. By a rotation about e, or about l of a face that
// leans, the place below a node moves along the edge too.
BIRM3D_INLINE Turn turn_of_face(const IndentationNumbers& d, const Standing& n, const FollowedPlace& h,
                                const Packet& fe, const Packet& fw, const Packet& fl) {
    const Packet below = (n.l - n.up) * fw;
    const Packet e = n.up * fw - n.w * fl + below, w = n.up * fe + h.at * fl,
                 l = -1.0 * (h.at * fw + n.w * fe + d.tilt * below);
    return {e * d.ex + w * d.wx + l * d.lx, e * d.ey + w * d.wy + l * d.ly, e * d.ez + w * d.wz + l * d.lz};
}

}  // namespace

void find_indentation(const IndentationNumbers& d, const IndentationNumbers& then, const PanelNodes& nodes,
                      const KnownFaces& known);
double find_indentation_gap(const IndentationNumbers& d, const PanelNodes& nodes);

void find_indentation(const IndentationNumbers& d, const IndentationNumbers& then, const PanelNodes& nodes,
                      const KnownFaces& known) {
    const Packet zero = 0.0;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        zero.store(known.follows + i);
        const Standing n = stand(d, nodes, i), was = stand(then, nodes, i);
        if (!any_matters(nodes, known, no_less_than(d, n), i)) continue;
        const FollowedPlace h = find_followed(d, n);
        const Drawn by = drawn(d, h);
        const Packet outward = outward_displacement(n, was, by, drawn(then, find_followed(then, was)));
        const Asked asked = ask(d, nodes, known, n, h, outward, i);
        const Packet state = find_state(d, nodes, known, n, was, asked, i);
        if (!any_above(state, zero)) continue;
        state.store(known.follows + i);
        const auto put = [&](double* column, const Packet& found) {
            where_above(state, zero, found, Packet::load(column + i)).store(column + i);
        };
        const Packet over = n.l - n.up, fe = by.in,
                     fw = by.across + where_above(over, zero, d.edge_slope, d.face_slope) * fe,
                     fl = where_above(over, zero, zero, fe * d.tilt);
        const Packet nx = fe * d.ex - fw * d.wx - fl * d.lx, ny = fe * d.ey - fw * d.wy - fl * d.ly,
                     nz = fe * d.ez - fw * d.wz - fl * d.lz;
        const Packet size = square_root(fe * fe + fw * fw + fl * fl), per = 1.0 / size;
        put(known.gap, asked.gap);
        put(known.rank, asked.rank);
        put(known.bx, d.ex);
        put(known.by, d.ey);
        put(known.bz, d.ez);
        put(known.nx, nx * per);
        put(known.ny, ny * per);
        put(known.nz, nz * per);
        put(known.per_force, size);
        put(known.px, d.ox + (h.at * d.ex + h.a * d.wx + n.up * d.lx));
        put(known.py, d.oy + (h.at * d.ey + h.a * d.wy + n.up * d.ly));
        put(known.pz, d.oz + (h.at * d.ez + h.a * d.wz + n.up * d.lz));

        const Turn q = d.is_face ? turn_of_face(d, n, h, fe, fw, fl) : turn_of_post(d, n, fe, fw, fl);
        put(known.tx, per * (d.oy * nz - d.oz * ny + q.x));
        put(known.ty, per * (d.oz * nx - d.ox * nz + q.y));
        put(known.tz, per * (d.ox * ny - d.oy * nx + q.z));
    }
}

double find_indentation_gap(const IndentationNumbers& d, const PanelNodes& nodes) {
    Packet least = infinitely_far;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        const Standing s = stand(d, nodes, i);
        const Packet zero = 0.0, gap = where_drawn(d, s, zero, find_followed(d, s).gap, infinitely_far);
        least = lesser(least, where_on(nodes, gap, infinitely_far, i));
    }
    return least_of(least);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
