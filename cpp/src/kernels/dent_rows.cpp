// Compiled once for each instruction set; see base/row.hpp for what that forbids.
#include "kernels/dent_rows.hpp"

#include "base/row.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

// Where a panel ends, the way in which its nodes hang on a post that stands beside it changes over within this (m): the
// outermost stand on the edge itself, and rounding would choose.
constexpr double edge_width = 1e-3;

// Depth of the post's surface over that of its axis, at `a` across: itself, and for each unit across and of stretch.
struct Rise {
    Row rise, across, stretch;
};
BIRM3D_IN_LANE_LOOP Rise rise_at(const DentNumbers& d, const Row& a) {
    const Row zero = 0.0, steep_arc = d.steep_arc;
    const Row far = where_above(zero, a, -1.0 * a, a);
    const Row on = lesser(far, steep_arc);
    const Row root = square_root(d.radius * d.radius - on * on);
    return {where_above(far, steep_arc, d.rise_there - steepest * (far - steep_arc), d.stretch * root),
            where_above(far, steep_arc, where_above(zero, a, steepest, -steepest), -d.stretch * a / root),
            root};
}

// Where a row of nodes stands, in the post's axes; the middle of the post, as high as they are.
struct Standing {
    Row e, w, l, up, deepest;
};
BIRM3D_IN_LANE_LOOP Standing stand(const DentNumbers& d, const PanelNodes& nodes, std::size_t i) {
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
BIRM3D_IN_LANE_LOOP Row no_less_than(const DentNumbers& d, const Standing& s) {
    const Row zero = 0.0, by_depth = (s.deepest - d.surface) * d.per_reach;
    const Row slope = lesser(greater(by_depth, least_slope), steepest);
    const Row beside = greater(where_above(s.w, zero, s.w, -1.0 * s.w) - d.radius, zero);
    return s.e - (s.deepest - slope * (beside + (s.l - s.up)));
}

// The place of the post that a row of nodes hangs on.
struct Hanging {
    Slope<Row> slope;  // of the skin beside the post
    Row arc, highest, lowest, a, at, beyond, gap;
    Rise rise;
};
BIRM3D_IN_LANE_LOOP Hanging hang(const DentNumbers& d, const Standing& s) {
    Hanging h;
    h.slope = slope_at<Row>(s.deepest - d.surface, d.per_reach);
    const Row low = d.low, high = d.high;
    // The nearest place of the post that falls off no more steeply than the dent, within the panel.
    const Row share = h.slope.slope * d.per_stretch;
    const Row arc = d.radius * share / square_root(1.0 + share * share);
    h.arc = lesser(greater(s.w, -1.0 * arc), arc);
    h.highest = greater(s.w, high);
    h.lowest = lesser(s.w, low);
    h.a = where_above(h.arc, h.highest, h.highest, where_above(h.lowest, h.arc, h.lowest, h.arc));
    h.rise = rise_at(d, h.a);
    h.at = d.tilt * s.up + h.rise.rise;
    h.beyond = where_above(s.w, h.a, s.w - h.a, h.a - s.w) + (s.l - s.up);
    h.gap = s.e - (h.at - h.slope.slope * h.beyond);
    return h;
}

// `yes` for nodes of the panel, else `no`.
BIRM3D_IN_LANE_LOOP Row where_on(const PanelNodes& nodes, const Row& yes, const Row& no, std::size_t i) {
    const Row zero = 0.0, off = Row::load(nodes.panel + i) - nodes.of;
    return where_above(off * off, zero, no, yes);
}

// Does it matter to any node where the dent is, no gap being less than this?
BIRM3D_IN_LANE_LOOP bool any_matters(const PanelNodes& nodes, const SeenColumns& seen, const Row& least,
                                     std::size_t i) {
    const Row zero = 0.0;
    const Row below = where_above(Row::load(nodes.force + i), zero, infinitely_far, zero);
    const Row so_far = Row::load(seen.gap + i);
    return any_above(where_on(nodes, lesser(below, so_far), -infinitely_far, i), least);
}

// What the edges of the panel add to how the depth changes as the post turns about e: nodes that hang on one hang beside
// the post wherever that goes.
BIRM3D_IN_LANE_LOOP Row at_edges(const DentNumbers& d, const Standing& n, const Hanging& h) {
    const Row zero = 0.0, one = 1.0, s = h.slope.slope;
    const auto at_edge = [&](const Row& of_high, const Row& of_low, const Row& of_neither) {
        return where_above(h.arc, h.highest, of_high, where_above(h.lowest, h.arc, of_low, of_neither));
    };
    const Row within = at_edge(d.high - n.w, n.w - d.low, zero);
    const Row part = lesser(greater(0.5 + within * (0.5 / edge_width), zero), one);
    const Row share = at_edge(part, part, zero);
    const Row edge = at_edge(d.high_at, d.low_at, zero), side = at_edge(-1.0 * s, s, s);
    return share * (side * (n.l - edge) + h.rise.across * (n.l - edge));
}

// Which nodes hang on the dent (1, else 0)?
BIRM3D_IN_LANE_LOOP Row find_hanging(const DentNumbers& d, const PanelNodes& nodes, const SeenColumns& seen,
                                     const Row& gap, std::size_t i) {
    const Row zero = 0.0, one = 1.0, so_far = Row::load(seen.gap + i);
    const Row against =
        d.ex * Row::load(seen.nx + i) + d.ey * Row::load(seen.ny + i) + d.ez * Row::load(seen.nz + i);
    const Row drawn_in = where_above(zero, so_far - against * gap, zero, one);
    return where_on(nodes, where_above(so_far, gap, where_above(zero, against, drawn_in, one), zero), zero,
                    i);
}

}  // namespace

void find_dent(const DentNumbers& d, const PanelNodes& nodes, const SeenColumns& seen);
double find_dent_gap(const DentNumbers& d, const PanelNodes& nodes);

void find_dent(const DentNumbers& d, const PanelNodes& nodes, const SeenColumns& seen) {
    const Row zero = 0.0, top = d.top, top_leans = d.top_rate * d.per_stretch;
    for (std::size_t i = 0; i < lanes; i += row_length) {
        zero.store(seen.hangs + i);
        const Standing n = stand(d, nodes, i);
        if (!any_matters(nodes, seen, no_less_than(d, n), i)) continue;
        const Hanging h = hang(d, n);
        const Row hangs = find_hanging(d, nodes, seen, h.gap, i);
        if (!any_above(hangs, zero)) continue;
        hangs.store(seen.hangs + i);
        const auto tell = [&](double* column, const Row& found) {
            where_above(hangs, zero, found, Row::load(column + i)).store(column + i);
        };
        const Row s = h.slope.slope;
        // As the post goes deeper, the slope grows.
        const Row less = h.slope.grows * h.beyond;
        const Row rises = where_above(n.l, top, -1.0 * s, d.tilt),
                  leans = where_above(n.l, top, zero, d.tilt);
        const Row fe = 1.0 - less, fw = h.rise.across, fl = rises - less * leans;
        const Row nx = fe * d.ex - fw * d.wx - fl * d.lx, ny = fe * d.ey - fw * d.wy - fl * d.ly,
                  nz = fe * d.ez - fw * d.wz - fl * d.lz;
        const Row size = square_root(fe * fe + fw * fw + fl * fl), per = 1.0 / size;
        tell(seen.gap, h.gap);
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

        // How the depth changes as the post turns about e, with the dent, and as its axis leans along e.
        Row about = fl * n.w - h.rise.across * n.l;
        if (any_above(h.arc, h.highest) || any_above(h.lowest, h.arc)) about = about + at_edges(d, n, h);
        const Row leaning = d.stretch * d.stretch * fe * n.up +
                            d.stretch * d.tilt * (h.rise.stretch - less * d.radius) +
                            where_above(n.l, top, (fe * d.tilt + s) * top_leans, zero);
        const Row qx = about * (d.tilt * d.lx - d.ex) + leaning * d.wx,
                  qy = about * (d.tilt * d.ly - d.ey) + leaning * d.wy,
                  qz = about * (d.tilt * d.lz - d.ez) + leaning * d.wz;
        tell(seen.tx, per * (d.oy * nz - d.oz * ny + qx));
        tell(seen.ty, per * (d.oz * nx - d.ox * nz + qy));
        tell(seen.tz, per * (d.ox * ny - d.oy * nx + qz));
    }
}

double find_dent_gap(const DentNumbers& d, const PanelNodes& nodes) {
    Row least = infinitely_far;
    for (std::size_t i = 0; i < lanes; i += row_length)
        least = lesser(least, where_on(nodes, hang(d, stand(d, nodes, i)).gap, infinitely_far, i));
    return least_of(least);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
