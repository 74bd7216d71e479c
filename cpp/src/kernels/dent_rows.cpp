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

// Where a row of nodes stands, in the post's axes; the middle of the post and the slope beside it, as high as they are.
struct Standing {
    Row e, w, l, up, deepest;
    Slope<Row> slope;
};
BIRM3D_IN_LANE_LOOP Standing stand(const DentNumbers& d, const double* x, const double* y, const double* z,
                                   std::size_t i) {
    Standing s;
    const Row rx = Row::load(x + i) - d.ox, ry = Row::load(y + i) - d.oy, rz = Row::load(z + i) - d.oz;
    const Row top = d.top;
    s.e = d.ex * rx + d.ey * ry + d.ez * rz;
    s.w = d.wx * rx + d.wy * ry + d.wz * rz;
    s.l = d.lx * rx + d.ly * ry + d.lz * rz;
    s.up = lesser(s.l, top);
    s.deepest = d.tilt * s.up + d.stretch * d.radius;
    s.slope = slope_at<Row>(s.deepest - d.surface, d.per_reach);
    return s;
}

// No gap is less: as if the post were as deep all across as in its middle.
BIRM3D_IN_LANE_LOOP Row no_less_than(const DentNumbers& d, const Standing& s) {
    const Row zero = 0.0;
    const Row beside = greater(where_above(s.w, zero, s.w, -1.0 * s.w) - d.radius, zero);
    return s.e - (s.deepest - s.slope.slope * (beside + (s.l - s.up)));
}

// The place of the post that a row of nodes hangs on.
struct Hanging {
    Row arc, highest, lowest, a, at, beyond, gap;
    Rise rise;
};
BIRM3D_IN_LANE_LOOP Hanging hang(const DentNumbers& d, const Standing& s) {
    Hanging h;
    const Row low = d.low, high = d.high;
    // The nearest place of the post that falls off no more steeply than the dent, within the panel.
    const Row share = s.slope.slope * d.per_stretch;
    const Row arc = d.radius * share / square_root(1.0 + share * share);
    h.arc = lesser(greater(s.w, -1.0 * arc), arc);
    h.highest = greater(s.w, high);
    h.lowest = lesser(s.w, low);
    h.a = where_above(h.arc, h.highest, h.highest, where_above(h.lowest, h.arc, h.lowest, h.arc));
    h.rise = rise_at(d, h.a);
    h.at = d.tilt * s.up + h.rise.rise;
    h.beyond = where_above(s.w, h.a, s.w - h.a, h.a - s.w) + (s.l - s.up);
    h.gap = s.e - (h.at - s.slope.slope * h.beyond);
    return h;
}

// `yes` for nodes of the panel, else `no`.
BIRM3D_IN_LANE_LOOP Row where_on(const double* panel, double of, const Row& yes, const Row& no,
                                 std::size_t i) {
    const Row zero = 0.0, off = Row::load(panel + i) - of;
    return where_above(off * off, zero, no, yes);
}

BIRM3D_IN_LANE_LOOP bool any_matters(const DentedNodes& nodes, const Row& gap, std::size_t i) {
    const Row zero = 0.0;
    const Row below = where_above(Row::load(nodes.force + i), zero, infinitely_far, zero);
    const Row so_far = Row::load(nodes.gap + i);
    return any_above(where_on(nodes.panel, nodes.of, lesser(below, so_far), -infinitely_far, i), gap);
}

}  // namespace

void find_dent(const DentNumbers& d, const double* x, const double* y, const double* z,
               const DentedNodes& nodes, const DentColumns& out);
double find_dent_gap(const DentNumbers& d, const double* x, const double* y, const double* z,
                     const double* panel, double of);

void find_dent(const DentNumbers& d, const double* x, const double* y, const double* z,
               const DentedNodes& nodes, const DentColumns& out) {
    const Row zero = 0.0, one = 1.0, top = d.top;
    for (std::size_t i = 0; i < lanes; i += row_length) {
        Row(infinitely_far).store(out.gap + i);
        const Standing n = stand(d, x, y, z, i);
        if (!any_matters(nodes, no_less_than(d, n), i)) continue;
        const Hanging h = hang(d, n);
        const Row s = n.slope.slope;
        // As the post goes deeper, the slope grows.
        const Row less = n.slope.grows * h.beyond;
        const Row rises = where_above(n.l, top, -1.0 * s, d.tilt),
                  leans = where_above(n.l, top, zero, d.tilt);
        const Row fe = 1.0 - less, fw = h.rise.across, fl = rises - less * leans;
        const Row nx = fe * d.ex - fw * d.wx - fl * d.lx, ny = fe * d.ey - fw * d.wy - fl * d.ly,
                  nz = fe * d.ez - fw * d.wz - fl * d.lz;
        const Row size = square_root(nx * nx + ny * ny + nz * nz), per = 1.0 / size;
        h.gap.store(out.gap + i);
        (nx * per).store(out.nx + i);
        (ny * per).store(out.ny + i);
        (nz * per).store(out.nz + i);
        size.store(out.per_force + i);
        (d.ox + (h.at * d.ex + h.a * d.wx + n.up * d.lx)).store(out.px + i);
        (d.oy + (h.at * d.ey + h.a * d.wy + n.up * d.ly)).store(out.py + i);
        (d.oz + (h.at * d.ez + h.a * d.wz + n.up * d.lz)).store(out.pz + i);

        // How the depth changes as the post turns about e, with the dent, and as its axis leans along e.
        const auto at_edge = [&](const Row& of_high, const Row& of_low, const Row& of_neither) {
            return where_above(h.arc, h.highest, of_high, where_above(h.lowest, h.arc, of_low, of_neither));
        };
        const Row within = at_edge(d.high - n.w, n.w - d.low, zero);
        const Row part = lesser(greater(0.5 + within * (0.5 / edge_width), zero), one);
        const Row share = at_edge(part, part, zero);
        const Row edge = at_edge(d.high_at, d.low_at, d.low_at), side = at_edge(-1.0 * s, s, s);
        const Row about = share * (side * (n.l - edge) - h.rise.across * edge) -
                          (1.0 - share) * h.rise.across * n.l + fl * n.w;
        const Row leaning = d.stretch * d.stretch * fe * n.up +
                            d.stretch * d.tilt * (h.rise.stretch - less * d.radius) +
                            where_above(n.l, top, (fe * d.tilt + s) * (d.top_rate / d.stretch), zero);
        const Row qx = about * (d.tilt * d.lx - d.ex) + leaning * d.wx,
                  qy = about * (d.tilt * d.ly - d.ey) + leaning * d.wy,
                  qz = about * (d.tilt * d.lz - d.ez) + leaning * d.wz;
        (per * (d.oy * nz - d.oz * ny + qx)).store(out.tx + i);
        (per * (d.oz * nx - d.ox * nz + qy)).store(out.ty + i);
        (per * (d.ox * ny - d.oy * nx + qz)).store(out.tz + i);
    }
}

double find_dent_gap(const DentNumbers& d, const double* x, const double* y, const double* z,
                     const double* panel, double of) {
    Row least = infinitely_far;
    for (std::size_t i = 0; i < lanes; i += row_length)
        least = lesser(least, where_on(panel, of, hang(d, stand(d, x, y, z, i)).gap, infinitely_far, i));
    return least_of(least);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
