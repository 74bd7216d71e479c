// Compiled once for each instruction set; see base/packet.hpp for what that forbids.
#include "kernels/indentation_simd.hpp"

#include "base/packet.hpp"
#include "kernels/indentation_packets.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

// A node that was further inside a face than this as the step began is not held by it (m).
constexpr double least_lag = 1e-8;

// The face of a wall holds a node that pushes beside its edge if it is no further away: more than a step's motion (m).
constexpr double in_reach = 0.01;

// `yes` for nodes that a face of the edge holds, else `no`: they are further along it than the axis of the edge. A face that
// falls off from the panel holds those that lie on it alone: without skin on the other side they slide along it.
// A node that lags inside the face stays with the edge. The face would move it in one step, and the energy would jump.
BIRM3D_INLINE Packet where_beside_face(const IndentationNumbers& d, const KnownFaces& known,
                                       const Standing& s, const FollowedPlace& h, const Packet& yes,
                                       const Packet& no, std::size_t i) {
    const Packet zero = 0.0;
    Packet held = no;
    for (const EdgeFace& face : d.face) {
        if (face.slope > steepest) continue;
        const Packet along = face.e * (s.e - d.tilt * s.up) + face.w * s.w;
        const Packet by_this = is_nearly_parallel(face) ? yes : where_above(h.alone, zero, yes, held);
        held = where_above(along, zero, by_this, held);
    }
    return where_above(Packet::load(known.lags + i), zero, no, held);
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

// Cosine of the normal of the surface that each node is on, and the panel's direction.
BIRM3D_INLINE Packet cosine_of_surface(const IndentationNumbers& d, const KnownFaces& known, std::size_t i) {
    return d.ex * Packet::load(known.nx + i) + d.ey * Packet::load(known.ny + i) +
           d.ez * Packet::load(known.nz + i);
}

// By how much another surface must be nearer than the edge's face to hold skin that lies on it (m): the face itself is no other
// surface, to rounding and to the chords of its arc.
constexpr double coincident = 1e-3;

// Gap to another surface that stops the node from following the indentation. It is infinite where no surface does.
BIRM3D_INLINE Packet gap_of_holding_surface(const IndentationNumbers& d, const KnownFaces& known,
                                            const FollowedPlace& h, std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far, faces = Packet::load(known.least_facing + i);
    const Packet along = cosine_of_surface(d, known, i);
    const Packet gap = where_above(along, faces, Packet::load(known.contact_gap + i), far);
    const Packet other =
        where_above(h.on_face, zero, where_above(h.gap * along - gap, coincident, gap, far), gap);
    return where_above(Packet::load(known.per_force + i), zero, far, other);
}

// Gap of nodes that do not push (m): e - D, with D of kernels/indentation.hpp. A node inside is at most as deep as the post drew
// it in within the step. Beside the face of a wall, its edge holds no node.
BIRM3D_INLINE Packet gap_of_free(const IndentationNumbers& d, const KnownFaces& known, const Standing& s,
                                 const FollowedPlace& h, const Packet& outward, std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far;
    const Packet reached = where_above(h.gap, zero, h.gap, greater(h.gap, outward));
    return where_beside_face(d, known, s, h, far, reached, i);
}

// Gap of loaded nodes under the indentation (m): their displacement du within the step, so that their depth u follows the post.
// A node that another surface holds follows the indentation only once that has reached it.
BIRM3D_INLINE Packet gap_of_loaded(const IndentationNumbers& d, const KnownFaces& known,
                                   const FollowedPlace& h, const Packet& outward, std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far;
    const Packet unless_held = where_above(far, gap_of_holding_surface(d, known, h, i), far, outward);
    return where_above(zero, h.gap, outward, unless_held);
}

// 1 where the indentation extends over a node, else 0: D is beyond the panel's outermost node there.
BIRM3D_INLINE Packet extends_over(const IndentationNumbers& d, const KnownFaces& known, const Standing& s,
                                  const FollowedPlace& h, std::size_t i) {
    const Packet zero = 0.0, one = 1.0, surface = d.surface, holds = d.grip > 0.0 ? one : zero;
    return where_above(s.e - h.gap, surface, where_beside_face(d, known, s, h, zero, holds, i), zero);
}

// The gap that the indentation asks of each node (m). A loaded node follows the indentation while that extends over it, and is
// released afterwards. An unloaded one follows once the indentation has reached it.
struct RequiredGap {
    Packet gap;
    Packet releases;  // 1 for nodes that the indentation releases, else 0
    Packet rank;      // of several indentations, that of lowest rank holds the node: the deepest one there
};
BIRM3D_INLINE RequiredGap required_gap(const IndentationNumbers& d, const PanelNodes& nodes,
                                       const KnownFaces& known, const Standing& s, const FollowedPlace& h,
                                       const Packet& outward, std::size_t i) {
    const Packet zero = 0.0, one = 1.0, far = infinitely_far, pushes = Packet::load(nodes.force + i);
    const Packet extends = extends_over(d, known, s, h, i);
    const Packet of_loaded = where_above(extends, zero, gap_of_loaded(d, known, h, outward, i), away);
    const Packet gap = where_above(pushes, zero, of_loaded, gap_of_free(d, known, s, h, outward, i));
    const Packet releases = where_above(pushes, zero, where_above(extends, zero, zero, one), zero);
    return {gap, releases, where_above(releases, zero, away, where_above(far, gap, h.gap, far))};
}

// `state`, but 0 for nodes that the indentation would draw into the surface that holds them so far. Nodes that lag inside the
// surface are left out of that.
BIRM3D_INLINE Packet unless_drawn_inside(const IndentationNumbers& d, const KnownFaces& known,
                                         const FollowedPlace& h, const Packet& gap, const Packet& state,
                                         std::size_t i) {
    // Skin on a face of the edge goes with the edge, though the face is a surface that holds it, too.
    const Packet zero = 0.0, favour = where_above(h.on_face, zero, coincident, zero),
                 gap_so_far = Packet::load(known.gap + i) + favour;
    const Packet facing = cosine_of_surface(d, known, i);
    const Packet outside = where_above(zero, gap_so_far - facing * gap, zero, state);
    return where_above(Packet::load(known.lags + i), zero, state, where_above(zero, facing, outside, state));
}

// Rank of what holds each node so far: of a loaded node an indentation's rank or the gap of a surface (m), of a free node the
// gap.
BIRM3D_INLINE Packet rank_so_far(const IndentationNumbers& d, const PanelNodes& nodes,
                                 const KnownFaces& known, const Standing& s, const FollowedPlace& h,
                                 std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far, near = in_reach, gap_so_far = Packet::load(known.gap + i);
    const Packet by_indentation =
        where_above(Packet::load(known.per_force + i), zero, Packet::load(known.rank + i),
                    gap_of_holding_surface(d, known, h, i));
    const Packet by_face = where_above(gap_so_far, near, far, gap_so_far);
    const Packet of_free = where_above(Packet::load(known.lags + i), zero, by_indentation, gap_so_far);
    return where_above(Packet::load(nodes.force + i), zero,
                       where_beside_face(d, known, s, h, by_face, by_indentation, i), of_free);
}

// State of the nodes in this indentation: 1 for those that follow it, 2 for those that it releases, else 0. Of
// several indentations the deepest one at the node governs. A choice by displacements would alternate from step to
// step.
BIRM3D_INLINE Packet find_state(const IndentationNumbers& d, const PanelNodes& nodes, const KnownFaces& known,
                                const Standing& s, const FollowedPlace& h, const Standing& was,
                                const RequiredGap& required, std::size_t i) {
    const Packet zero = 0.0, one = 1.0, pushes = Packet::load(nodes.force + i);
    const Packet state = unless_drawn_inside(d, known, h, required.gap, one + required.releases, i);
    const Packet rank = where_above(pushes, zero, required.rank, required.gap);
    const Packet nearest = where_above(rank_so_far(d, nodes, known, s, h, i), rank, state, zero);
    // How far a node that pushes or lags was behind the face as the step began (m).
    const Packet lag =
        where_above(greater(pushes, Packet::load(known.lags + i)), zero, was.deepest - was.e, zero);
    return where_on(nodes, where_drawn(d, s, lag, nearest, zero), zero, i);
}

// Displacement of nodes, as a vector in body axes, for a unit rotation of the post or the face about its foot.
struct Turn {
    Packet x, y, z;
};

// By rotation of the post about e, by tilt of its axis along e, and by rotation of an edge's face.
BIRM3D_INLINE Turn turn_of_post(const IndentationNumbers& d, const Standing& n, const Packet& fe,
                                const Packet& fw, const Packet& fl, const Packet& by_turn) {
    const Packet zero = 0.0, top = d.top, top_leans = d.top_rate * d.per_stretch;
    const Packet about = fl * n.w - fw * n.l;
    const Packet leaning = fe * (d.stretch * d.stretch * n.up + d.stretch * d.tilt * d.radius +
                                 where_above(n.l, top, d.tilt * top_leans, zero));
    const Packet by_l = by_turn * where_above(n.w, zero, d.side_high.turn_l, d.side_low.turn_l),
                 by_w = leaning + by_turn * where_above(n.w, zero, d.side_high.turn_w, d.side_low.turn_w);
    return {about * (d.tilt * d.lx - d.ex) + by_w * d.wx + by_l * d.lx,
            about * (d.tilt * d.ly - d.ey) + by_w * d.wy + by_l * d.ly,
            about * (d.tilt * d.lz - d.ez) + by_w * d.wz + by_l * d.lz};
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
        const Packet outward = outward_displacement(n, was, by, drawn(then, find_followed(then, was)),
                                                    slope_of_face(then, was) - slope_of_face(d, n));
        const RequiredGap required = required_gap(d, nodes, known, n, h, outward, i);
        const Packet state = find_state(d, nodes, known, n, h, was, required, i);
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
        put(known.gap, required.gap);
        put(known.rank, required.rank);
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

        const Turn q =
            d.is_face ? turn_of_face(d, n, h, fe, fw, fl) : turn_of_post(d, n, fe, fw, fl, by.by_turn);
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
