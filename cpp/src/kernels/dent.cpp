#include "birm3d/kernels/dent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace birm3d {

namespace {

// Slope of a post's flank where a panel ends on it: beyond it small motions would make great forces.
constexpr double steepest = 5.0;

// Slope of a dent that is no more than a touch. Less steep, a post beside a bowed front would draw in its middle.
constexpr double least_slope = 0.25;

// Where a panel ends, the way in which its nodes hang on a post that stands beside it changes over within this (m): the
// outermost stand on the edge itself, and rounding would choose.
constexpr double edge_width = 1e-3;

// A rim's highest place, sine * radius above the middle of the top, is rounded off below this sine: at a corner there the
// torque would jump.
constexpr double rounded = 0.05;

// Sine of the angle between a post's axis and a panel beyond which it does not begin to dent it, or ceases to.
constexpr double most_tilted = 0.5, overturned = 0.95;

// A dent for the lane loop: plain numbers, and the flank from where it is steepest.
struct Numbers {
    double ex, ey, ez, wx, wy, wz, lx, ly, lz, ox, oy, oz;
    double low, high, low_at, high_at, top, top_rate, tilt, radius, stretch, surface, per_reach;
    double steep_arc, rise_there;
};

Numbers numbers_of(const Dent& d) {
    const double share = steepest / d.stretch, sine = share / std::sqrt(1.0 + share * share);
    const Vec3 &e = d.into, &w = d.across, &l = d.along, &o = d.foot;
    return {e.x(),
            e.y(),
            e.z(),
            w.x(),
            w.y(),
            w.z(),
            l.x(),
            l.y(),
            l.z(),
            o.x(),
            o.y(),
            o.z(),
            d.low,
            d.high,
            d.low_at,
            d.high_at,
            d.top,
            d.top_rate,
            d.tilt,
            d.radius,
            d.stretch,
            d.surface,
            1.0 / d.reach,
            sine * d.radius,
            d.stretch * d.radius * std::sqrt(1.0 - sine * sine)};
}

// Of the post that has come `depth` in; `grows`: for each unit of it.
struct Slope {
    double slope, grows;
};
BIRM3D_IN_LANE_LOOP Slope slope_at(double depth, double per_reach) {
    const double by_depth = depth > 0.0 ? depth * per_reach : 0.0;
    const double slope = std::sqrt(least_slope * least_slope + by_depth * by_depth);
    const bool steep = slope > steepest;
    return {steep ? steepest : slope, steep ? 0.0 : by_depth * per_reach / slope};
}

// Depth of the post's surface over that of its axis, at `a` across: itself, and for each unit across and of stretch.
struct Rise {
    double rise, across, stretch;
};
BIRM3D_IN_LANE_LOOP Rise rise_at(const Numbers& d, double a) {
    const double far = a < 0.0 ? -a : a;
    const bool round = far <= d.steep_arc;
    const double on = round ? far : d.steep_arc;
    const double root = std::sqrt(d.radius * d.radius - on * on);
    return {round ? d.stretch * root : d.rise_there - steepest * (far - d.steep_arc),
            round ? -d.stretch * a / root : (a < 0.0 ? steepest : -steepest), root};
}

// `gap_only`: `all` is not used.
template <bool gap_only>
BIRM3D_IN_LANE_LOOP void dent_in_loop(const Numbers& d, const Lanes& x, const Lanes& y, const Lanes& z,
                                      Lanes& gap, [[maybe_unused]] DentLanes* all) {
    const double ex = d.ex, ey = d.ey, ez = d.ez, wx = d.wx, wy = d.wy, wz = d.wz, lx = d.lx, ly = d.ly,
                 lz = d.lz, ox = d.ox, oy = d.oy, oz = d.oz;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double rx = x[i] - ox, ry = y[i] - oy, rz = z[i] - oz;
        const double e = ex * rx + ey * ry + ez * rz;
        const double w = wx * rx + wy * ry + wz * rz;
        const double l = lx * rx + ly * ry + lz * rz;
        const bool above = l > d.top;
        const double up = above ? d.top : l;
        const Slope slope = slope_at(d.tilt * up + d.stretch * d.radius - d.surface, d.per_reach);
        const double s = slope.slope;
        // The nearest place of the post that falls off no more steeply than the dent, within the panel.
        const double share = s / d.stretch, arc = d.radius * share / std::sqrt(1.0 + share * share);
        const double on_arc = w > arc ? arc : (w < -arc ? -arc : w);
        const double highest = w > d.high ? w : d.high, lowest = w < d.low ? w : d.low;
        const double a = on_arc > highest ? highest : (on_arc < lowest ? lowest : on_arc);
        const Rise rise = rise_at(d, a);
        const double at = d.tilt * up + rise.rise;
        const double beside = w > a ? w - a : a - w;
        gap[i] = e - (at - s * (beside + (l - up)));
        if constexpr (gap_only) continue;

        DentLanes& out = *all;
        // As the post goes deeper, the slope grows.
        const double less = slope.grows * (beside + (l - up));
        const double rises = above ? -s : d.tilt, leans = above ? 0.0 : d.tilt;
        const double fe = 1.0 - less, fw = rise.across, fl = rises - less * leans;
        const double nx = fe * ex - fw * wx - fl * lx, ny = fe * ey - fw * wy - fl * ly,
                     nz = fe * ez - fw * wz - fl * lz;
        const double size = std::sqrt(nx * nx + ny * ny + nz * nz), per = 1.0 / size;
        out.nx[i] = nx * per;
        out.ny[i] = ny * per;
        out.nz[i] = nz * per;
        out.per_force[i] = size;
        out.px[i] = ox + (at * ex + a * wx + up * lx);
        out.py[i] = oy + (at * ey + a * wy + up * ly);
        out.pz[i] = oz + (at * ez + a * wz + up * lz);

        // How the depth changes as the post turns about e, with the dent, and as its axis leans along e.
        const bool by_high = on_arc > highest, by_low = on_arc < lowest;
        const double within = by_high ? d.high - w : (by_low ? w - d.low : 0.0);
        const double part = 0.5 + 0.5 * within / edge_width;
        const double at_edge = by_high || by_low ? (part < 0.0 ? 0.0 : (part > 1.0 ? 1.0 : part)) : 0.0;
        const double edge = by_high ? d.high_at : d.low_at, side = by_high ? -s : s;
        const double about =
            at_edge * (side * (l - edge) - rise.across * edge) - (1.0 - at_edge) * rise.across * l + fl * w;
        const double leaning = d.stretch * d.stretch * fe * up +
                               d.stretch * d.tilt * (rise.stretch - less * d.radius) +
                               (above ? (fe * d.tilt + s) * d.top_rate / d.stretch : 0.0);
        const double qx = about * (d.tilt * lx - ex) + leaning * wx,
                     qy = about * (d.tilt * ly - ey) + leaning * wy,
                     qz = about * (d.tilt * lz - ez) + leaning * wz;
        out.tx[i] = per * (oy * nz - oz * ny + qx);
        out.ty[i] = per * (oz * nx - ox * nz + qy);
        out.tz[i] = per * (ox * ny - oy * nx + qz);
    }
}

BIRM3D_LANE_LOOP void dent_of_block(const Numbers& d, const Lanes& x, const Lanes& y, const Lanes& z,
                                    DentLanes& out) {
    dent_in_loop<false>(d, x, y, z, out.gap, &out);
}

BIRM3D_LANE_LOOP void gap_of_block(const Numbers& d, const Lanes& x, const Lanes& y, const Lanes& z,
                                   Lanes& gap) {
    dent_in_loop<true>(d, x, y, z, gap, nullptr);
}

}  // namespace

Dent::Dent(const Post& post, const Placement& stands, const Panel& panel, double reach_)
    : into(panel.inward), foot(stands.from_own(Vec3::Zero())), radius(post.radius), reach(reach_) {
    const Vec3 axis_up = stands.direction_from_own(Vec3::UnitZ());
    const double leaning = axis_up.dot(into), upright = axis_up.cross(into).norm();
    across = axis_up.cross(into) / upright;
    along = (axis_up - leaning * into) / upright;
    // The middles of the edges at either side. Corners of the box would change places with every sway of the post.
    Eigen::Index side = 0;
    across.cwiseAbs().maxCoeff(&side);
    const Vec3 edge = std::copysign(panel.box.half[side], across[side]) * Vec3::Unit(side);
    const Vec3 middle = panel.box.center - foot, least = middle - edge, most = middle + edge;
    low = least.dot(across);
    high = most.dot(across);
    low_at = least.dot(along);
    high_at = most.dot(along);
    surface = middle.dot(into) - panel.box.half.dot(into.cwiseAbs());
    tilt = leaning / upright;
    stretch = 1.0 / upright;
    const double rim = std::hypot(leaning, rounded);
    top = post.height * upright + radius * rim;
    top_rate = radius * leaning / rim - post.height * tilt;
}

double Dent::beside(const Panel& panel) const {
    const double bottom = (panel.box.center - foot).dot(along) - panel.box.half.dot(along.cwiseAbs());
    return std::max({low - radius, -radius - high, bottom - top});
}

// By the post's own way, across its flanks, and by the growth of the slope.
double Dent::fastest_growth(const Panel& panel) const {
    const Vec3 middle = panel.box.center - foot;
    const double at = middle.dot(along), half = panel.box.half.dot(along.cwiseAbs());
    const double deepest =
        stretch * radius + std::max(tilt * std::min(at - half, top), tilt * std::min(at + half, top));
    return 2.0 + slope_at(deepest - surface, 1.0 / reach).slope;
}

bool stands_across(const Placement& post, const Panel& panel, bool dents) {
    const double sine = std::abs(post.direction_from_own(Vec3::UnitZ()).dot(panel.inward));
    return sine < (dents ? overturned : most_tilted);
}

namespace {

// Of a skin `beside` a post that is at most this deep: greatest of p - slope(p) beside over depths p. Within reach the
// deepest post draws it in most; beyond, one of some depth, or one so deep that the slope grows no more.
double most_drawn_in(double deepest, double beside, double reach) {
    const double by_deepest = deepest - slope_at(deepest, 1.0 / reach).slope * beside;
    if (beside <= reach) return by_deepest;
    const double further = std::sqrt(beside * beside - reach * reach);
    return deepest * further < reach * reach * least_slope ? by_deepest
                                                           : std::max(by_deepest, -least_slope * further);
}

}  // namespace

double most_inside(const Dent& d, const Box& box) {
    const auto range = [&](const Vec3& way) {
        const double middle = (box.center - d.foot).dot(way), half = box.half.dot(way.cwiseAbs());
        return std::pair(middle - half, middle + half);
    };
    const double outermost = range(d.into).first;
    const auto [w0, w1] = range(d.across);
    const auto [l0, l1] = range(d.along);
    const double deepest =
        d.stretch * d.radius + std::max(d.tilt * std::min(l0, d.top), d.tilt * std::min(l1, d.top));
    const double beside = std::max({w0 - d.radius, -d.radius - w1, 0.0}) + std::max(l0 - d.top, 0.0);
    const double depth = deepest - d.surface;
    return d.surface + most_drawn_in(depth, beside, d.reach) - outermost;
}

void gap_of(const Dent& dent, const TrussBlockState& nodes, Lanes& gap) {
    gap_of_block(numbers_of(dent), nodes.x, nodes.y, nodes.z, gap);
}

void dent_of(const Dent& dent, const TrussBlockState& nodes, DentLanes& out) {
    dent_of_block(numbers_of(dent), nodes.x, nodes.y, nodes.z, out);
}

}  // namespace birm3d
