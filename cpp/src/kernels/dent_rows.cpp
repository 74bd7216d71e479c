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

// Where a row of nodes stands, in the post's axes, and the place of the post that it hangs on.
struct Hanging {
    Row w, l, up, arc, highest, lowest, a, at, beyond, gap;
    Rise rise;
    Slope<Row> slope;
};

BIRM3D_IN_LANE_LOOP Hanging hang(const DentNumbers& d, const double* x, const double* y, const double* z,
                                 std::size_t i) {
    Hanging h;
    const Row rx = Row::load(x + i) - d.ox, ry = Row::load(y + i) - d.oy, rz = Row::load(z + i) - d.oz;
    const Row e = d.ex * rx + d.ey * ry + d.ez * rz, top = d.top, low = d.low, high = d.high;
    h.w = d.wx * rx + d.wy * ry + d.wz * rz;
    h.l = d.lx * rx + d.ly * ry + d.lz * rz;
    h.up = lesser(h.l, top);
    h.slope = slope_at<Row>(d.tilt * h.up + d.stretch * d.radius - d.surface, d.per_reach);
    // The nearest place of the post that falls off no more steeply than the dent, within the panel.
    const Row share = h.slope.slope * d.per_stretch;
    const Row arc = d.radius * share / square_root(1.0 + share * share);
    h.arc = lesser(greater(h.w, -1.0 * arc), arc);
    h.highest = greater(h.w, high);
    h.lowest = lesser(h.w, low);
    h.a = where_above(h.arc, h.highest, h.highest, where_above(h.lowest, h.arc, h.lowest, h.arc));
    h.rise = rise_at(d, h.a);
    h.at = d.tilt * h.up + h.rise.rise;
    h.beyond = where_above(h.w, h.a, h.w - h.a, h.a - h.w) + (h.l - h.up);
    h.gap = e - (h.at - h.slope.slope * h.beyond);
    return h;
}

BIRM3D_IN_LANE_LOOP bool any_matters(const DentedNodes& nodes, const Row& gap, std::size_t i) {
    const Row zero = 0.0;
    const Row off = Row::load(nodes.panel + i) - nodes.of;  // zero on the panel
    const Row below = where_above(Row::load(nodes.force + i), zero, infinitely_far, zero);
    const Row so_far = Row::load(nodes.gap + i);
    return any_above(where_above(off * off, zero, -infinitely_far, lesser(below, so_far)), gap);
}

}  // namespace

void find_dent(const DentNumbers& d, const double* x, const double* y, const double* z,
               const DentedNodes& nodes, const DentColumns& out);
void find_dent_gap(const DentNumbers& d, const double* x, const double* y, const double* z, double* gap);

void find_dent(const DentNumbers& d, const double* x, const double* y, const double* z,
               const DentedNodes& nodes, const DentColumns& out) {
    const Row zero = 0.0, one = 1.0, top = d.top;
    for (std::size_t i = 0; i < lanes; i += row_length) {
        const Hanging h = hang(d, x, y, z, i);
        if (!any_matters(nodes, h.gap, i)) {
            Row(infinitely_far).store(out.gap + i);
            continue;
        }
        const Row s = h.slope.slope;
        // As the post goes deeper, the slope grows.
        const Row less = h.slope.grows * h.beyond;
        const Row rises = where_above(h.l, top, -1.0 * s, d.tilt),
                  leans = where_above(h.l, top, zero, d.tilt);
        const Row fe = 1.0 - less, fw = h.rise.across, fl = rises - less * leans;
        const Row nx = fe * d.ex - fw * d.wx - fl * d.lx, ny = fe * d.ey - fw * d.wy - fl * d.ly,
                  nz = fe * d.ez - fw * d.wz - fl * d.lz;
        const Row size = square_root(nx * nx + ny * ny + nz * nz), per = 1.0 / size;
        h.gap.store(out.gap + i);
        (nx * per).store(out.nx + i);
        (ny * per).store(out.ny + i);
        (nz * per).store(out.nz + i);
        size.store(out.per_force + i);
        (d.ox + (h.at * d.ex + h.a * d.wx + h.up * d.lx)).store(out.px + i);
        (d.oy + (h.at * d.ey + h.a * d.wy + h.up * d.ly)).store(out.py + i);
        (d.oz + (h.at * d.ez + h.a * d.wz + h.up * d.lz)).store(out.pz + i);

        // How the depth changes as the post turns about e, with the dent, and as its axis leans along e.
        const auto at_edge = [&](const Row& of_high, const Row& of_low, const Row& of_neither) {
            return where_above(h.arc, h.highest, of_high, where_above(h.lowest, h.arc, of_low, of_neither));
        };
        const Row within = at_edge(d.high - h.w, h.w - d.low, zero);
        const Row part = lesser(greater(0.5 + within * (0.5 / edge_width), zero), one);
        const Row share = at_edge(part, part, zero);
        const Row edge = at_edge(d.high_at, d.low_at, d.low_at), side = at_edge(-1.0 * s, s, s);
        const Row about = share * (side * (h.l - edge) - h.rise.across * edge) -
                          (1.0 - share) * h.rise.across * h.l + fl * h.w;
        const Row leaning = d.stretch * d.stretch * fe * h.up +
                            d.stretch * d.tilt * (h.rise.stretch - less * d.radius) +
                            where_above(h.l, top, (fe * d.tilt + s) * (d.top_rate / d.stretch), zero);
        const Row qx = about * (d.tilt * d.lx - d.ex) + leaning * d.wx,
                  qy = about * (d.tilt * d.ly - d.ey) + leaning * d.wy,
                  qz = about * (d.tilt * d.lz - d.ez) + leaning * d.wz;
        (per * (d.oy * nz - d.oz * ny + qx)).store(out.tx + i);
        (per * (d.oz * nx - d.ox * nz + qy)).store(out.ty + i);
        (per * (d.ox * ny - d.oy * nx + qz)).store(out.tz + i);
    }
}

void find_dent_gap(const DentNumbers& d, const double* x, const double* y, const double* z, double* gap) {
    for (std::size_t i = 0; i < lanes; i += row_length)
        hang(d, x, y, z, i).gap.store(gap + i);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
