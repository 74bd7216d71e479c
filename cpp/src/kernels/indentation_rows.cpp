// Compiled once for each instruction set; see base/row.hpp for what that forbids.
#include "kernels/indentation_rows.hpp"

#include "base/row.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

// The gap of nodes that an indentation lets go: any other holds them before (m).
constexpr double away = 10.0;

// Share with which the skin leans on the flank of a post. Chosen by hand between 0.1 and 0.4: with less, a pole 0.35 m off
// the middle gives less sideways than finite elements show; with more, posts at the end of a bumper are a wedge.
constexpr double lean = 0.35;

// Nodes that an indentation keeps are known by a share above zero.
constexpr double least_drawn = 1e-9;

// Nearer than this to another surface a node is held by that (m).
constexpr double touching = tolerance::touching_gap;

// Depth of the post's surface over that of its axis, at `a` across: itself, and for each unit across.
struct Rise {
    Row rise, across;
};
BIRM3D_INLINE Rise rise_at(const IndentationNumbers& d, const Row& a) {
    const Row zero = 0.0, steep_arc = d.steep_arc;
    const Row far = where_above(zero, a, -1.0 * a, a);
    const Row on = lesser(far, steep_arc);
    const Row root = square_root(d.radius * d.radius - on * on);
    return {where_above(far, steep_arc, d.rise_there - steepest * (far - steep_arc), d.stretch * root),
            where_above(far, steep_arc, where_above(zero, a, steepest, -steepest), -d.stretch * a / root)};
}

// Where a row of nodes stands, in the post's axes; the middle of the post, as high as they are.
struct Standing {
    Row e, w, l, up, deepest;
};
BIRM3D_INLINE Standing stand(const IndentationNumbers& d, const PanelNodes& nodes, std::size_t i) {
    Standing s;
    const Row rx = Row::load(nodes.x + i) - d.ox, ry = Row::load(nodes.y + i) - d.oy,
              rz = Row::load(nodes.z + i) - d.oz;
    const Row top = d.top;
    s.e = d.ex * rx + d.ey * ry + d.ez * rz;
    s.w = d.wx * rx + d.wy * ry + d.wz * rz;
    s.l = d.lx * rx + d.ly * ry + d.lz * rz;
    s.up = lesser(s.l, top);
    s.deepest = d.tilt * s.up + d.stretch * d.radius;
    return s;
}

// No gap is less: as if the post were as deep all across as in its middle, and the slope beside it no steeper than the
// greater of what it is made of.
BIRM3D_INLINE Row no_less_than(const IndentationNumbers& d, const Standing& s) {
    const Row zero = 0.0, by_depth = (s.deepest - d.surface) * d.per_reach;
    const Row slope = lesser(greater(by_depth, least_slope), steepest);
    const Row beside = greater(where_above(s.w, zero, s.w, -1.0 * s.w) - d.radius, zero);
    return s.e - (s.deepest - slope * (beside + (s.l - s.up)));
}

// The place of the post that a row of nodes follows on.
struct Hanging {
    Slope<Row> slope;  // of the skin beside the post
    Row a, at, beyond, gap;
    Rise rise;
};
BIRM3D_INLINE Hanging hang(const IndentationNumbers& d, const Standing& s) {
    Hanging h;
    h.slope = slope_at<Row>(s.deepest - d.surface, d.per_reach);
    const Row low = d.low, high = d.high;
    // The nearest place of the post that falls off no more steeply than the indentation, within the panel.
    const Row share = h.slope.slope * d.per_stretch;
    const Row arc = d.radius * share / square_root(1.0 + share * share);
    const Row near = lesser(greater(s.w, -1.0 * arc), arc), highest = greater(s.w, high),
              lowest = lesser(s.w, low);
    h.a = where_above(near, highest, highest, where_above(lowest, near, lowest, near));
    h.rise = rise_at(d, h.a);
    h.at = d.tilt * s.up + h.rise.rise;
    h.beyond = where_above(s.w, h.a, s.w - h.a, h.a - s.w) + (s.l - s.up);
    h.gap = s.e - (h.at - h.slope.slope * h.beyond);
    return h;
}

// `yes` for nodes of the panel, else `no`.
BIRM3D_INLINE Row where_on(const PanelNodes& nodes, const Row& yes, const Row& no, std::size_t i) {
    const Row zero = 0.0, off = Row::load(nodes.panel + i) - nodes.of;
    return where_above(off * off, zero, no, yes);
}

// Does it matter to any node where the indentation is, no gap being less than this?
BIRM3D_INLINE bool any_matters(const PanelNodes& nodes, const SeenColumns& seen, const Row& least,
                               std::size_t i) {
    const Row zero = 0.0;
    const Row so_far = Row::load(seen.gap + i);
    const Row below = where_above(Row::load(nodes.force + i), zero, infinitely_far, lesser(so_far, zero));
    return any_above(where_on(nodes, below, -infinitely_far, i), least);
}

// How far a node that the indentation draws in goes along e for each unit that the post comes in, and that it goes along the
// panel.
struct Drawn {
    Row in, across;
};
BIRM3D_INLINE Drawn drawn(const IndentationNumbers& d, const Hanging& h) {
    const Row slope = h.slope.slope, flank = lesser(greater(h.rise.across, -1.0 * slope), slope);
    return {greater(d.grip * (1.0 - h.slope.grows * h.beyond), least_drawn),
            (lean * d.grip) * flank / square_root(1.0 + flank * flank)};
}

// Way of the nodes within the step, outwards.
BIRM3D_INLINE Row way_of(const Standing& now, const Standing& then, const Drawn& at_end,
                         const Drawn& at_start) {
    const Row in = (now.deepest - now.e) - (then.deepest - then.e), across = now.w - then.w;
    return -0.5 * ((at_end.in + at_start.in) * in + (at_end.across + at_start.across) * across);
}

// The gap to another surface that holds the node against the way of the indentation; infinite where none does. One that it glides
// on, as the ground below a bumper, does not.
BIRM3D_INLINE Row held_by_other(const IndentationNumbers& d, const SeenColumns& seen, std::size_t i) {
    const Row zero = 0.0, far = infinitely_far, faces = 0.5, near = touching;
    const Row gap = Row::load(seen.gap + i), along = d.ex * Row::load(seen.nx + i) +
                                                     d.ey * Row::load(seen.ny + i) +
                                                     d.ez * Row::load(seen.nz + i);
    const Row held = where_above(along, faces, where_above(gap, near, far, gap), far);
    return where_above(Row::load(seen.per_force + i), zero, far, held);
}

// Required gap of each node. A loaded node follows the indentation while that extends over it, and is released afterwards.
// An unloaded one follows once the indentation has reached it.
struct Asked {
    Row gap, lets_go, rank;
};
BIRM3D_INLINE Asked ask(const IndentationNumbers& d, const PanelNodes& nodes, const SeenColumns& seen,
                        const Standing& s, const Hanging& h, const Row& way, std::size_t i) {
    const Row zero = 0.0, one = 1.0, far = infinitely_far, surface = d.surface;
    const Row pushes = Row::load(nodes.force + i), held = d.grip > 0.0 ? one : zero;
    const Row comes = where_above(h.gap, zero, h.gap, greater(h.gap, way));
    // A node that another surface holds is not the indentation's before that comes to it.
    const Row other = where_above(far, held_by_other(d, seen, i), far, way);
    const Row goes = where_above(zero, h.gap, way, other);
    const Row reaches = where_above(s.e - h.gap, surface, held, zero);
    const Row off = where_above(pushes, zero, where_above(reaches, zero, zero, one), zero);
    const Row gap = where_above(pushes, zero, where_above(reaches, zero, goes, away), comes);
    return {gap, off, where_above(off, zero, away, where_above(far, gap, h.gap, far))};
}

// Nodes of this indentation: one for those that follow it, two for those that it releases, else zero. Of several the deepest
// one at the node governs. By their displacements the choice would alternate from step to step.
BIRM3D_INLINE Row find_own(const IndentationNumbers& d, const PanelNodes& nodes, const SeenColumns& seen,
                           const Asked& asked, std::size_t i) {
    const Row zero = 0.0, one = 1.0, so_far = Row::load(seen.gap + i), gap = asked.gap;
    const Row against =
        d.ex * Row::load(seen.nx + i) + d.ey * Row::load(seen.ny + i) + d.ez * Row::load(seen.nz + i);
    const Row own = one + asked.lets_go;
    const Row drawn_in = where_above(zero, so_far - against * gap, zero, own);
    const Row nearer = where_above(zero, against, drawn_in, own);
    const Row pushes = Row::load(nodes.force + i), by_surface = held_by_other(d, seen, i);
    const Row by_dent =
        where_above(Row::load(seen.per_force + i), zero, Row::load(seen.rank + i), by_surface);
    const Row last = where_above(pushes, zero, by_dent, so_far);
    const Row now = where_above(pushes, zero, asked.rank, gap);
    return where_on(nodes, where_above(last, now, nearer, zero), zero, i);
}

}  // namespace

void find_indentation(const IndentationNumbers& d, const IndentationNumbers& then, const PanelNodes& nodes,
                      const SeenColumns& seen);
double find_indentation_gap(const IndentationNumbers& d, const PanelNodes& nodes);

void find_indentation(const IndentationNumbers& d, const IndentationNumbers& then, const PanelNodes& nodes,
                      const SeenColumns& seen) {
    const Row zero = 0.0, top = d.top, top_leans = d.top_rate * d.per_stretch;
    for (std::size_t i = 0; i < block_size; i += row_length) {
        zero.store(seen.follows + i);
        const Standing n = stand(d, nodes, i), was = stand(then, nodes, i);
        if (!any_matters(nodes, seen, no_less_than(d, n), i)) continue;
        const Hanging h = hang(d, n);
        const Drawn by = drawn(d, h);
        const Row way = way_of(n, was, by, drawn(then, hang(then, was)));
        const Asked asked = ask(d, nodes, seen, n, h, way, i);
        const Row own = find_own(d, nodes, seen, asked, i);
        if (!any_above(own, zero)) continue;
        own.store(seen.follows + i);
        const auto tell = [&](double* column, const Row& found) {
            where_above(own, zero, found, Row::load(column + i)).store(column + i);
        };
        const Row fe = by.in, fw = by.across, fl = where_above(n.l, top, zero, fe * d.tilt);
        const Row nx = fe * d.ex - fw * d.wx - fl * d.lx, ny = fe * d.ey - fw * d.wy - fl * d.ly,
                  nz = fe * d.ez - fw * d.wz - fl * d.lz;
        const Row size = square_root(fe * fe + fw * fw + fl * fl), per = 1.0 / size;
        tell(seen.gap, asked.gap);
        tell(seen.rank, asked.rank);
        tell(seen.bx, d.ex);
        tell(seen.by, d.ey);
        tell(seen.bz, d.ez);
        tell(seen.nx, nx * per);
        tell(seen.ny, ny * per);
        tell(seen.nz, nz * per);
        tell(seen.per_force, size);
        tell(seen.px, d.ox + (h.at * d.ex + h.a * d.wx + n.up * d.lx));
        tell(seen.py, d.oy + (h.at * d.ey + h.a * d.wy + n.up * d.ly));
        tell(seen.pz, d.oz + (h.at * d.ez + h.a * d.wz + n.up * d.lz));

        // How the node goes as the post turns about e, and as its axis leans along e.
        const Row about = fl * n.w - fw * n.l;
        const Row leaning = fe * (d.stretch * d.stretch * n.up + d.stretch * d.tilt * d.radius +
                                  where_above(n.l, top, d.tilt * top_leans, zero));
        const Row qx = about * (d.tilt * d.lx - d.ex) + leaning * d.wx,
                  qy = about * (d.tilt * d.ly - d.ey) + leaning * d.wy,
                  qz = about * (d.tilt * d.lz - d.ez) + leaning * d.wz;
        tell(seen.tx, per * (d.oy * nz - d.oz * ny + qx));
        tell(seen.ty, per * (d.oz * nx - d.ox * nz + qy));
        tell(seen.tz, per * (d.ox * ny - d.oy * nx + qz));
    }
}

double find_indentation_gap(const IndentationNumbers& d, const PanelNodes& nodes) {
    Row least = infinitely_far;
    for (std::size_t i = 0; i < block_size; i += row_length)
        least = lesser(least, where_on(nodes, hang(d, stand(d, nodes, i)).gap, infinitely_far, i));
    return least_of(least);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
