#include "kernels/indentation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/block_loop.hpp"
#include "kernels/simd_table.hpp"

namespace birm3d {

namespace {

// Below this sine of the tilt, the highest point of the rim is rounded off. Otherwise the torque would jump there.
constexpr double rounded = 0.05;

// Sine of the angle between a post's axis and a panel beyond which it does not begin to indent it, or ceases to.
constexpr double most_tilted = 0.5, overturned = 0.95;

// An edge begins to indent a panel if the cosine of its angle to the wall's face exceeds the first, and stops below the second.
// A panel that slides along the end of the wall meets the edge as it meets any surface.
constexpr double least_facing = 0.7, turned_away = 0.3;

// Sideways force of the skin on a post's flank, relative to that on a frictionless wedge. It is chosen by hand; 0.1 to 0.4
// would do. With less, a pole 0.35 m off the middle gives less sideways than finite elements show. With more, posts at the end
// of a bumper throw it aside.
constexpr double post_flank = 0.35;

// `side`: 1 on the open side of an edge, -1 before its wall, 0 on the flank of a post. Before the wall the factor is zero: the
// wall's face holds the skin there.
double flank_factor(double side, double open_flank) {
    return (1.0 - std::abs(side)) * post_flank + std::max(side, 0.0) * open_flank;
}

// 1 if the edge opens to higher w, -1 if to lower. The free quadrant's bisector makes 45 degrees with w head-on.
double open_side(const Vec3& w, const Placement& stands, double opens) {
    const Vec3 open = stands.direction_from_own(Vec3(std::cos(opens), std::sin(opens), 0.0));
    return std::clamp(std::sqrt(2.0) * w.dot(open), -1.0, 1.0);
}

// Cosine of the angle between a panel and the face of the wall whose edge stands there: 1 head-on.
double facing(const Vec3& inward, const Placement& stands) {
    return -inward.dot(stands.direction_from_own(Vec3::UnitX()));
}

// From the axis of an edge towards the other end of its wall.
Vec3 direction_along_wall(const Placement& stands, double opens) {
    return stands.direction_from_own(Vec3(0.0, -std::copysign(1.0, std::sin(opens)), 0.0));
}

BIRM3D_BLOCK_LOOP double furthest(const BlockColumn& panel_of, double panel, const BlockColumn& force,
                                  const BlockColumn& gap) {
    alignas(64) BlockColumn most;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        most[i] = panel_of[i] == panel && force[i] > 0.0 && gap[i] > 0.0 ? gap[i] : 0.0;
    return block_max(most);
}

}  // namespace

Indentation::Indentation(const Post& post, const Placement& stands, const Panel& panel, double length_,
                         double edge_flank_factor)
    : length(length_) {
    const Vec3 &e = panel.inward, o = stands.from_own(Vec3::Zero());
    const Vec3 axis_up = stands.direction_from_own(Vec3::UnitZ());
    const double leaning = axis_up.dot(e), upright = axis_up.cross(e).norm();
    stretch = 1.0 / upright;
    const Vec3 w = stretch * axis_up.cross(e), l = stretch * (axis_up - leaning * e);
    ex = e.x(), ey = e.y(), ez = e.z();
    wx = w.x(), wy = w.y(), wz = w.z();
    lx = l.x(), ly = l.y(), lz = l.z();
    ox = o.x(), oy = o.y(), oz = o.z();
    radius = post.radius;
    tilt = stretch * leaning;
    const double rim = std::sqrt(leaning * leaning + rounded * rounded);
    top = post.height * upright + radius * rim;
    top_rate = radius * leaning / rim - post.height * tilt;
    surface = (panel.box.center - o).dot(e) - panel.box.half.dot(e.cwiseAbs());
    const Box outline = post.opens ? panel.box : outline_at(panel, radius);
    // The middles of the edges at either side. Corners of the box would alternate with small rotations of the post.
    Eigen::Index side = 0;
    w.cwiseAbs().maxCoeff(&side);
    const Vec3 edge = std::copysign(outline.half[side], w[side]) * Vec3::Unit(side);
    const Vec3 middle = outline.center - o, least = middle - edge, most = middle + edge;
    low = least.dot(w);
    high = most.dot(w);
    bottom = middle.dot(l) - outline.half.dot(l.cwiseAbs());
    const double off = std::min(1.0, std::max({low, -high, 0.0}) / post.radius);
    grip = 1.0 - off * off;
    // A panel that ends before the edge's axis meets only its rounding. Then the edge counts as a post.
    const double opens =
        post.opens ? std::max(0.0, 1.0 - 2.0 * off) * open_side(w, stands, *post.opens) : 0.0;
    flank_low = flank_factor(-opens, edge_flank_factor);
    flank_high = flank_factor(opens, edge_flank_factor);
    const Vec3 along_wall = post.opens ? direction_along_wall(stands, *post.opens) : Vec3(Vec3::Zero());
    wall_e = e.dot(along_wall);
    wall_w = w.dot(along_wall);
    per_reach = 1.0 / length;
    per_stretch = upright;
    const double slope_there = steepest * upright, cosine = 1.0 / std::sqrt(1.0 + slope_there * slope_there);
    steep_arc = slope_there * cosine * radius;
    rise_there = stretch * radius * cosine;
}

double Indentation::deepest_place(const Panel& panel) const {
    const double at = (panel.box.center - foot()).dot(along()), half = panel.box.half.dot(along().cwiseAbs());
    return stretch * radius + std::max(tilt * std::min(at - half, top), tilt * std::min(at + half, top));
}

double Indentation::beside() const {
    return std::max({low - radius, -radius - high, bottom - top});
}

bool Indentation::is_beyond(const Panel& panel) const {
    const Box& box = panel.anchors;
    const Vec3 middle = box.center - foot();
    const double at = middle.dot(along()), half = box.half.dot(along().cwiseAbs());
    const double nearest = std::min(tilt * std::min(at - half, top), tilt * std::min(at + half, top));
    return middle.dot(into()) + box.half.dot(into().cwiseAbs()) < nearest - stretch * radius;
}

// From the post's displacement, its flanks, and the growth of the slope.
double Indentation::fastest_growth(const Panel& panel) const {
    return 2.0 + slope_at<double>(deepest_place(panel) - surface, per_reach).slope;
}

bool can_indent(const Post& post, const Placement& stands, const Panel& panel, bool indents) {
    const double sine = std::abs(stands.direction_from_own(Vec3::UnitZ()).dot(panel.inward));
    if (!(sine < (indents ? overturned : most_tilted))) return false;
    return !post.opens || facing(panel.inward, stands) > (indents ? turned_away : least_facing);
}

namespace {

// Greatest indentation at the distance `beside` from a post of at most this depth: the maximum of p - slope(p) beside
// over depths p.
double most_drawn_in(double deepest, double beside, double reach) {
    const double by_deepest = deepest - slope_at<double>(deepest, 1.0 / reach).slope * beside;
    if (beside <= reach) return by_deepest;
    const double further = std::sqrt(beside * beside - reach * reach);
    return deepest * further < reach * reach * least_slope ? by_deepest
                                                           : std::max(by_deepest, -least_slope * further);
}

struct BoxInIndentation {
    double outermost, depth, drawn_in;
};

BoxInIndentation box_in_indentation(const Indentation& d, const Box& box) {
    const auto range = [&](const Vec3& axis) {
        const double middle = (box.center - d.foot()).dot(axis), half = box.half.dot(axis.cwiseAbs());
        return std::pair(middle - half, middle + half);
    };
    const double outermost = range(d.into()).first;
    const auto [w0, w1] = range(d.across());
    const auto [l0, l1] = range(d.along());
    const double deepest =
        d.stretch * d.radius + std::max(d.tilt * std::min(l0, d.top), d.tilt * std::min(l1, d.top));
    const double beside = std::max({w0 - d.radius, -d.radius - w1, 0.0}) + std::max(l0 - d.top, 0.0);
    const double depth = deepest - d.surface;
    return {outermost, depth, most_drawn_in(depth, beside, d.length)};
}

}  // namespace

double most_inside(const Indentation& d, const Box& box) {
    const BoxInIndentation in = box_in_indentation(d, box);
    return d.surface + in.drawn_in - in.outermost;
}

bool spans(const Indentation& d, const Box& box) {
    return box_in_indentation(d, box).drawn_in > 0.0;
}

double gap_of(const Indentation& indentation, const TrussBlockState& nodes, const BlockColumn& panel_of,
              std::size_t panel) {
    return simd.find_indentation_gap(
        indentation, {nodes.x.data(), nodes.y.data(), nodes.z.data(), nodes.force.data(), panel_of.data(),
                      static_cast<double>(panel)});
}

void follow_indentation(const Indentation& indentation, const Indentation& then, const TrussBlockState& nodes,
                        const BlockColumn& panel_of, std::size_t panel, const BlockColumn& contact_gap,
                        const BlockColumn& least_facing, const BlockColumn& lags, NodeFaces& faces,
                        BlockContact& contact, BlockColumn& rank, BlockColumn& follows) {
    simd.find_indentation(
        indentation, then,
        {nodes.x.data(), nodes.y.data(), nodes.z.data(), nodes.force.data(), panel_of.data(),
         static_cast<double>(panel)},
        {faces.gap.data(), faces.per_force.data(), faces.bx.data(), faces.by.data(), faces.bz.data(),
         contact.nx.data(), contact.ny.data(), contact.nz.data(), contact.px.data(), contact.py.data(),
         contact.pz.data(), contact.tx.data(), contact.ty.data(), contact.tz.data(), rank.data(),
         follows.data(), contact_gap.data(), least_facing.data(), lags.data()});
}

double furthest_off(const TrussBlockState& nodes, const BlockColumn& panel_of, std::size_t panel,
                    const BlockColumn& gap) {
    return furthest(panel_of, static_cast<double>(panel), nodes.force, gap);
}

}  // namespace birm3d
