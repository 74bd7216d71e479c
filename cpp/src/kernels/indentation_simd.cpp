// Compiled once for each instruction set; see base/packet.hpp for what that forbids.
#include "kernels/indentation_simd.hpp"

#include "base/packet.hpp"
#include "kernels/followed_place.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

// Least value that marks a node as following an indentation.
constexpr double least_drawn = 1e-9;

// A node that was further inside a face than this as the step began is not held by it (m).
constexpr double least_lag = 1e-8;

// The face of a wall holds a node that pushes beside its edge if it is no further away: more than a step's motion (m).
constexpr double in_reach = 0.01;

// Lower bound of the gaps: the post is taken as deep everywhere as in its middle, with the least slope beside it.
BIRM3D_INLINE Packet no_less_than(const IndentationNumbers& d, const Standing& s) {
    const Packet zero = 0.0, by_depth = (s.deepest - d.surface) * d.per_reach;
    const Packet flattest_face = d.side_low.slope < d.side_high.slope ? d.side_low.slope : d.side_high.slope;
    const Packet slope = lesser(lesser(greater(by_depth, least_slope), steepest), flattest_face);
    const Packet beside = greater(greater(s.w - d.most_w, d.least_w - s.w), zero);
    return s.e - (s.deepest - slope * (beside + (s.l - s.up)));
}

// `yes` for nodes that a face of the edge holds, else `no`: they are further along it than the axis of the edge. A face that falls
// off from the panel holds those that lie on it alone: without skin on the other side nothing keeps them from sliding along it.
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

// Outward displacement of the nodes within the step. `flatter`: by how much the slope of the edge's face has become less.
BIRM3D_INLINE Packet outward_displacement(const Standing& now, const Standing& then, const Drawn& at_end,
                                          const Drawn& at_start, const Packet& flatter) {
    const Packet zero = 0.0, in = (now.deepest - now.e) - (then.deepest - then.e), across = now.w - then.w;
    const Packet turn = where_above(lesser(at_end.by_turn, at_start.by_turn), zero, flatter, zero);
    return -0.5 * ((at_end.in + at_start.in) * in + (at_end.across + at_start.across) * across +
                   (at_end.by_turn + at_start.by_turn) * turn);
}

// By how much another surface must be nearer than the edge's face to hold skin that lies on it (m): the face itself is no other
// surface, to rounding and to the chords of its arc.
constexpr double coincident = 1e-3;

// Gap to another surface that stops the node from following the indentation. It is infinite where no surface does.
BIRM3D_INLINE Packet gap_of_holding_surface(const IndentationNumbers& d, const KnownFaces& known,
                                            const FollowedPlace& h, std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far, faces = Packet::load(known.least_facing + i);
    const Packet along = d.ex * Packet::load(known.nx + i) + d.ey * Packet::load(known.ny + i) +
                         d.ez * Packet::load(known.nz + i);
    const Packet gap = where_above(along, faces, Packet::load(known.contact_gap + i), far);
    const Packet other =
        where_above(h.on_face, zero, where_above(h.gap * along - gap, coincident, gap, far), gap);
    return where_above(Packet::load(known.per_force + i), zero, far, other);
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
    const Packet other = where_above(far, gap_of_holding_surface(d, known, h, i), far, outward);
    const Packet goes = where_above(zero, h.gap, outward, other);
    const Packet reaches =
        where_above(s.e - h.gap, surface, where_beside_face(d, known, s, h, zero, holds, i), zero);
    const Packet off = where_above(pushes, zero, where_above(reaches, zero, zero, one), zero);
    const Packet gap = where_above(pushes, zero, where_above(reaches, zero, goes, away),
                                   where_beside_face(d, known, s, h, far, comes, i));
    return {gap, off, where_above(off, zero, away, where_above(far, gap, h.gap, far))};
}

// State of the nodes in this indentation: 1 for those that follow it, 2 for those that it releases, else 0. Of
// several indentations the deepest one at the node governs. A choice by displacements would alternate from step to
// step.
BIRM3D_INLINE Packet find_state(const IndentationNumbers& d, const PanelNodes& nodes, const KnownFaces& known,
                                const Standing& s, const FollowedPlace& h, const Standing& was,
                                const Asked& asked, std::size_t i) {
    const Packet zero = 0.0, one = 1.0, so_far = Packet::load(known.gap + i), gap = asked.gap;
    const Packet against = d.ex * Packet::load(known.nx + i) + d.ey * Packet::load(known.ny + i) +
                           d.ez * Packet::load(known.nz + i);
    const Packet state = one + asked.releases;
    const Packet favour = where_above(h.on_face, zero, coincident, zero);
    const Packet drawn_in = where_above(zero, so_far + favour - against * gap, zero, state);
    const Packet lags = Packet::load(known.lags + i);
    const Packet nearer = where_above(lags, zero, state, where_above(zero, against, drawn_in, state));
    const Packet pushes = Packet::load(nodes.force + i), by_surface = gap_of_holding_surface(d, known, h, i);
    const Packet by_indentation =
        where_above(Packet::load(known.per_force + i), zero, Packet::load(known.rank + i), by_surface);
    const Packet near = in_reach, far = infinitely_far, by_face = where_above(so_far, near, far, so_far);
    const Packet free_last = where_above(lags, zero, by_indentation, so_far);
    const Packet last =
        where_above(pushes, zero, where_beside_face(d, known, s, h, by_face, by_indentation, i), free_last);
    const Packet now = where_above(pushes, zero, asked.rank, gap);
    const Packet lag = where_above(greater(pushes, lags), zero, was.deepest - was.e, zero);
    const Packet found = where_drawn(d, s, lag, where_above(last, now, nearer, zero), zero);
    return where_on(nodes, found, zero, i);
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
        const Asked asked = ask(d, nodes, known, n, h, outward, i);
        const Packet state = find_state(d, nodes, known, n, h, was, asked, i);
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
