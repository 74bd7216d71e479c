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
BIRM3D_INLINE Packet where_beside_face(const IndentationNumbers& indentation, const KnownFaces& known,
                                       const NodePlace& place, const FollowedPlace& followed,
                                       const Packet& yes, const Packet& no, std::size_t i) {
    const Packet zero = 0.0;
    Packet held = no;
    for (const EdgeFace& face : indentation.face) {
        if (face.slope > steepest) continue;
        const Packet along = face.e * (place.e - indentation.tilt * place.post_l) + face.w * place.w;
        const Packet by_this = is_nearly_parallel(face) ? yes : where_above(followed.alone, zero, yes, held);
        held = where_above(along, zero, by_this, held);
    }
    return where_above(Packet::load(known.lags + i), zero, no, held);
}

// `yes` for nodes that the post or the top edge can draw in, else `no`. Below its top edge a face holds the skin itself, apart
// from nodes that sank below the edge: they lag behind the face. `lag`: by how much (m).
BIRM3D_INLINE Packet where_drawn(const IndentationNumbers& indentation, const NodePlace& place,
                                 const Packet& lag, const Packet& yes, const Packet& no) {
    if (!indentation.is_face) return yes;
    const Packet zero = 0.0, one = 1.0, most = indentation.most_w, least = indentation.least_w;
    const Packet rise = place.l - (indentation.top + indentation.top_slope * place.w) + at_edge;
    const Packet above = greater(rise, lag - least_lag);
    const Packet within = where_above(place.w, most, zero, where_above(least, place.w, zero, one));
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
BIRM3D_INLINE Packet cosine_of_surface(const IndentationNumbers& indentation, const KnownFaces& known,
                                       std::size_t i) {
    return indentation.ex * Packet::load(known.nx + i) + indentation.ey * Packet::load(known.ny + i) +
           indentation.ez * Packet::load(known.nz + i);
}

// By how much another surface must be nearer than the edge's face to hold skin that lies on it (m): the face itself is no other
// surface, to rounding and to the chords of its arc.
constexpr double coincident = 1e-3;

// Gap to another surface that stops the node from following the indentation. It is infinite where no surface does.
BIRM3D_INLINE Packet gap_of_holding_surface(const IndentationNumbers& indentation, const KnownFaces& known,
                                            const FollowedPlace& followed, std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far, faces = Packet::load(known.least_facing + i);
    const Packet along = cosine_of_surface(indentation, known, i);
    const Packet gap = where_above(along, faces, Packet::load(known.contact_gap + i), far);
    const Packet other = where_above(followed.on_face, zero,
                                     where_above(followed.gap * along - gap, coincident, gap, far), gap);
    return where_above(Packet::load(known.per_force + i), zero, far, other);
}

// Gap of nodes that do not push (m): e - D, with D of kernels/indentation.hpp. A node inside is at most as deep as the post drew
// it in within the step. Beside the face of a wall, its edge holds no node. Where the panel ends above the top, none is drawn in.
BIRM3D_INLINE Packet gap_of_free(const IndentationNumbers& indentation, const KnownFaces& known,
                                 const NodePlace& place, const FollowedPlace& followed, const Packet& outward,
                                 std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far;
    const Packet within = where_above(followed.gap, zero, followed.gap, greater(followed.gap, outward));
    const Packet reached = where_above(place.overlap, zero, within, far);
    return where_beside_face(indentation, known, place, followed, far, reached, i);
}

// Gap of loaded nodes under the indentation (m): their displacement du within the step, so that their depth u follows the post.
// A node that another surface holds, as the ground, follows the indentation only once that is within `in_reach` of it.
BIRM3D_INLINE Packet gap_of_loaded(const IndentationNumbers& indentation, const KnownFaces& known,
                                   const FollowedPlace& followed, const Packet& outward, std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far;
    const Packet unless_held =
        where_above(far, gap_of_holding_surface(indentation, known, followed, i), far, outward);
    const Packet ahead = where_above(followed.gap, in_reach, far, unless_held);
    const Packet stands = where_above(far, Packet::load(known.contact_gap + i), ahead, unless_held);
    return where_above(zero, followed.gap, outward, stands);
}

// 1 where the indentation extends over a node, else 0: D is beyond the panel's outermost node there, and the panel comes down
// below the top of the post or the face.
BIRM3D_INLINE Packet extends_over(const IndentationNumbers& indentation, const KnownFaces& known,
                                  const NodePlace& place, const FollowedPlace& followed, std::size_t i) {
    const Packet zero = 0.0, one = 1.0, surface = indentation.surface,
                 holds = indentation.grip > 0.0 ? one : zero;
    const Packet beside = where_beside_face(indentation, known, place, followed, zero, holds, i),
                 reached = where_above(place.overlap, zero, beside, zero);
    return where_above(place.e - followed.gap, surface, reached, zero);
}

// The gap that the indentation asks of each node (m). A loaded node follows the indentation while that extends over it, and is
// released afterwards, unless it stands on another surface. An unloaded one follows once the indentation has reached it.
struct RequiredGap {
    Packet gap;
    Packet releases;  // 1 for nodes that the indentation releases, else 0
    Packet rank;      // of several indentations, that of lowest rank holds the node: the deepest one there
};
BIRM3D_INLINE RequiredGap required_gap(const IndentationNumbers& indentation, const PanelNodes& nodes,
                                       const KnownFaces& known, const NodePlace& place,
                                       const FollowedPlace& followed, const Packet& outward, std::size_t i) {
    const Packet zero = 0.0, one = 1.0, far = infinitely_far, pushes = Packet::load(nodes.force + i);
    const Packet extends = extends_over(indentation, known, place, followed, i);
    // What stands on another surface, as the ground, is held by that.
    const Packet left = where_above(far, Packet::load(known.contact_gap + i), far, away);
    const Packet of_loaded =
        where_above(extends, zero, gap_of_loaded(indentation, known, followed, outward, i), left);
    const Packet gap =
        where_above(pushes, zero, of_loaded, gap_of_free(indentation, known, place, followed, outward, i));
    const Packet lets_go = where_above(far, left, one, zero);
    const Packet releases = where_above(pushes, zero, where_above(extends, zero, zero, lets_go), zero);
    return {gap, releases, where_above(releases, zero, away, where_above(far, gap, followed.gap, far))};
}

// `state`, but 0 for nodes that the indentation would draw into the surface that holds them so far. Nodes that lag inside the
// surface are left out of that.
BIRM3D_INLINE Packet unless_drawn_inside(const IndentationNumbers& indentation, const KnownFaces& known,
                                         const FollowedPlace& followed, const Packet& gap,
                                         const Packet& state, std::size_t i) {
    // Skin on a face of the edge goes with the edge, though the face is a surface that holds it, too.
    const Packet zero = 0.0, favour = where_above(followed.on_face, zero, coincident, zero),
                 gap_so_far = Packet::load(known.gap + i) + favour;
    const Packet facing = cosine_of_surface(indentation, known, i);
    const Packet outside = where_above(zero, gap_so_far - facing * gap, zero, state);
    return where_above(Packet::load(known.lags + i), zero, state, where_above(zero, facing, outside, state));
}

// Rank of what holds each node so far: of a loaded node an indentation's rank or the gap of a surface (m), of a free node the
// gap.
BIRM3D_INLINE Packet rank_so_far(const IndentationNumbers& indentation, const PanelNodes& nodes,
                                 const KnownFaces& known, const NodePlace& place,
                                 const FollowedPlace& followed, std::size_t i) {
    const Packet zero = 0.0, far = infinitely_far, near = in_reach, gap_so_far = Packet::load(known.gap + i);
    const Packet by_indentation =
        where_above(Packet::load(known.per_force + i), zero, Packet::load(known.rank + i),
                    gap_of_holding_surface(indentation, known, followed, i));
    const Packet by_face = where_above(gap_so_far, near, far, gap_so_far);
    const Packet of_free = where_above(Packet::load(known.lags + i), zero, by_indentation, gap_so_far);
    return where_above(Packet::load(nodes.force + i), zero,
                       where_beside_face(indentation, known, place, followed, by_face, by_indentation, i),
                       of_free);
}

// State of the nodes in this indentation: 1 for those that follow it, 2 for those that it releases, else 0. Of
// several indentations the deepest one at the node governs. A choice by displacements would alternate from step to
// step.
BIRM3D_INLINE Packet find_state(const IndentationNumbers& indentation, const PanelNodes& nodes,
                                const KnownFaces& known, const NodePlace& place,
                                const FollowedPlace& followed, const NodePlace& place_before,
                                const RequiredGap& required, std::size_t i) {
    const Packet zero = 0.0, one = 1.0, pushes = Packet::load(nodes.force + i);
    const Packet state =
        unless_drawn_inside(indentation, known, followed, required.gap, one + required.releases, i);
    const Packet rank = where_above(pushes, zero, required.rank, required.gap);
    const Packet nearest =
        where_above(rank_so_far(indentation, nodes, known, place, followed, i), rank, state, zero);
    // How far a node that pushes or lags was behind the face as the step began (m).
    const Packet lag = where_above(greater(pushes, Packet::load(known.lags + i)), zero,
                                   place_before.deepest - place_before.e, zero);
    return where_on(nodes, where_drawn(indentation, place, lag, nearest, zero), zero, i);
}

}  // namespace

void find_indentation(const IndentationNumbers& indentation, const IndentationNumbers& then,
                      const PanelNodes& nodes, const KnownFaces& known);
double find_indentation_gap(const IndentationNumbers& indentation, const PanelNodes& nodes);

void find_indentation(const IndentationNumbers& indentation, const IndentationNumbers& then,
                      const PanelNodes& nodes, const KnownFaces& known) {
    const Packet zero = 0.0;
    const double ox = indentation.ox, oy = indentation.oy, oz = indentation.oz;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        zero.store(known.follows + i);
        const NodePlace place = place_of(indentation, nodes, i), place_before = place_of(then, nodes, i);
        if (!any_matters(nodes, known, no_less_than(indentation, place), i)) continue;
        const FollowedPlace followed = find_followed(indentation, place);
        const FollowingRate rate = following_rate(indentation, followed),
                            rate_before = following_rate(then, find_followed(then, place_before));
        const Packet flatter = slope_of_face(then, place_before) - slope_of_face(indentation, place);
        const Packet outward =
            outward_displacement(indentation, then, place, place_before, rate, rate_before, flatter);
        const RequiredGap required = required_gap(indentation, nodes, known, place, followed, outward, i);
        const Packet state =
            find_state(indentation, nodes, known, place, followed, place_before, required, i);
        if (!any_above(state, zero)) continue;
        state.store(known.follows + i);
        const auto put = [&](double* column, const Packet& found) {
            where_above(state, zero, found, Packet::load(column + i)).store(column + i);
        };
        const Push push = push_of(indentation, place, rate);
        const Vectors normal = in_body_axes(indentation, push.e, -1.0 * push.w, -1.0 * push.l);
        const Packet size = square_root(push.e * push.e + push.w * push.w + push.l * push.l),
                     per_size = 1.0 / size;
        put(known.gap, required.gap);
        put(known.rank, required.rank);
        put(known.bx, indentation.ex);
        put(known.by, indentation.ey);
        put(known.bz, indentation.ez);
        put(known.nx, normal.x * per_size);
        put(known.ny, normal.y * per_size);
        put(known.nz, normal.z * per_size);
        put(known.per_force, size);
        const Vectors point = in_body_axes(indentation, followed.e, followed.w, place.post_l);
        put(known.px, ox + point.x);
        put(known.py, oy + point.y);
        put(known.pz, oz + point.z);

        const Vectors turn = indentation.is_face ? turn_of_face(indentation, place, followed, push)
                                                 : turn_of_post(indentation, place, push, rate.by_turn);
        put(known.tx, per_size * (oy * normal.z - oz * normal.y + turn.x));
        put(known.ty, per_size * (oz * normal.x - ox * normal.z + turn.y));
        put(known.tz, per_size * (ox * normal.y - oy * normal.x + turn.z));
    }
}

double find_indentation_gap(const IndentationNumbers& indentation, const PanelNodes& nodes) {
    Packet least = infinitely_far;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        const NodePlace place = place_of(indentation, nodes, i);
        const Packet zero = 0.0, met = where_above(place.overlap, zero, find_followed(indentation, place).gap,
                                                   infinitely_far);
        const Packet gap = where_drawn(indentation, place, zero, met, infinitely_far);
        least = lesser(least, where_on(nodes, gap, infinitely_far, i));
    }
    return least_of(least);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
