#include "kernels/indentation.hpp"

#include <algorithm>
#include <cmath>

#include "base/block_loop.hpp"
#include "kernels/simd_table.hpp"

namespace birm3d {

namespace {

struct Range {
    double low, high;
};

// Below this sine of the tilt, the highest point of the rim is rounded off. Otherwise the torque would jump there.
constexpr double rounded = 0.05;

// Above this cosine of the body's upward axis and the post's, the lower edge of a panel is its lowest part. Else no part of the
// panel is left out.
constexpr double least_upright = 0.7, no_edge = 1e3;

// Greatest share of the skin's force that pushes sideways on a post's flank, or along a post that leans by up to 49 degrees. It
// is chosen by hand. Sideways 0.1 to 0.4 would do. With less, a pole 0.35 m off the middle gives less sideways than finite
// elements show. With more, posts at the end of a bumper throw it aside.
// Of leaning posts no measured force was found. A front that has folded round one is taken to hold along it as firmly as across.
// It holds no more than a friction coefficient of `most_hold` would. With post_flank alone, trucks stop at posts that lean by
// 70 degrees.
constexpr double post_flank = 0.35, most_hold = 0.6;

// Depth behind a panel's foremost node to which its width and lower edge are counted for a thin post (m). Small: a thin post
// passes the rounded corner of a front without load. Large: a post beside a bumper draws it in before anything is met.
constexpr double least_outline_depth = 0.2;

// `side`: 1 on the open side of an edge, -1 before its wall, 0 on the flank of a post. Before the wall the factor is zero: the
// wall's face holds the skin there.
double flank_factor(double side, double open_flank) {
    return (1.0 - std::abs(side)) * post_flank + std::max(side, 0.0) * open_flank;
}

// Where a wall ends, as a share of the panel's half width from its middle. From `beside_rails` outwards the wall misses the rails,
// as in tests with 25 % overlap. Inside of `on_rail` it has caught a rail, and the edge resists as a post does: rails hold the
// front on both sides of it. Rails are about a tenth of the half width wide. Sides and rears are taken alike.
constexpr double beside_rails = 0.5, on_rail = 0.4;

// Factor on the open side of an edge. `end`: distance of the wall's end from the panel's middle over the half width; negative
// where the wall reaches past the middle.
double open_flank_factor(double end, double edge_flank_factor) {
    const double outside = std::clamp((end - on_rail) / (beside_rails - on_rail), 0.0, 1.0);
    return post_flank + outside * (edge_flank_factor - post_flank);
}

// Push along a post that leans by the slope `tilt`, over that of a frictionless wedge.
double climbing_share(double tilt) {
    const double slope = std::abs(tilt), folded_round = 1.0 / std::hypot(1.0, slope / post_flank);
    if (slope <= most_hold) return folded_round;
    const double slides = (1.0 - most_hold / slope) / (1.0 + most_hold * slope);
    return std::max(folded_round, slides);
}

// 1 if the edge opens to higher w, -1 if to lower. The free quadrant's bisector makes 45 degrees with w head-on.
double open_side(const Vec3& w, const Placement& stands, double opens) {
    const Vec3 open = stands.direction_from_own(Vec3(std::cos(opens), std::sin(opens), 0.0));
    return std::clamp(std::sqrt(2.0) * w.dot(open), -1.0, 1.0);
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

void Indentation::set_axes(const Vec3& foot, const Vec3& axis_up, const Panel& panel) {
    const Vec3& e = panel.inward;
    const double leaning = axis_up.dot(e);
    per_stretch = axis_up.cross(e).norm();
    stretch = 1.0 / per_stretch;
    const Vec3 w = stretch * axis_up.cross(e), l = stretch * (axis_up - leaning * e);
    ex = e.x(), ey = e.y(), ez = e.z();
    wx = w.x(), wy = w.y(), wz = w.z();
    lx = l.x(), ly = l.y(), lz = l.z();
    ox = foot.x(), oy = foot.y(), oz = foot.z();
    tilt = stretch * leaning;
    surface = (panel.box.center - foot).dot(e) - panel.box.half.dot(e.cwiseAbs());
    per_reach = 1.0 / length;
    steeper = std::max(1.0, length / reach_above);
    upward = lz;
    edge_allowance = upward > least_upright ? 0.0 : no_edge;
}

void Indentation::set_outline(const Box& outline) {
    const Vec3 w = across(), l = along();
    // The middles of the edges at either side. Corners of the box would alternate with small rotations of the post.
    Eigen::Index side = 0;
    w.cwiseAbs().maxCoeff(&side);
    const Vec3 edge = std::copysign(outline.half[side], w[side]) * Vec3::Unit(side);
    const Vec3 middle = outline.center - foot(), least = middle - edge, most = middle + edge;
    low = least.dot(w);
    high = most.dot(w);
    bottom = middle.dot(l) - outline.half.dot(l.cwiseAbs());
    ceiling = middle.dot(l) + outline.half.dot(l.cwiseAbs());
}

Indentation::Indentation(const TopEdge& edge, const Placement& stands, const Panel& panel, double length_)
    : length(length_) {
    const Vec3 axis_up = stands.direction_from_own(Vec3::UnitZ());
    set_axes(stands.from_own({edge.x, 0.0, 0.0}), axis_up, panel);
    set_outline(panel.box);
    const Vec3 line = stands.direction_from_own(Vec3::UnitY());  // of the edge
    const double line_e = line.dot(into()), line_w = line.dot(across()), line_l = line.dot(along());
    least_w = std::min(edge.low * line_w, edge.high * line_w);
    most_w = std::max(edge.low * line_w, edge.high * line_w);
    top = edge.height * per_stretch;
    top_slope = line_l / line_w;
    edge_slope = line_e / line_w;
    face_slope = edge_slope - tilt * top_slope;
    is_face = true;
    grip = along_factor = 1.0;
    radius = top_rate = flank_low = flank_high = steep_arc = rise_there = 0.0;
}

Indentation::Indentation(const Post& post, const Placement& stands, const Panel& panel, double length_,
                         double edge_flank_factor)
    : length(length_) {
    const Vec3& e = panel.inward;
    const Vec3 axis_up = stands.direction_from_own(Vec3::UnitZ());
    set_axes(stands.from_own(Vec3::Zero()), axis_up, panel);
    const Vec3 w = across();
    const double leaning = axis_up.dot(e), upright = per_stretch;
    radius = post.radius;
    least_w = -radius, most_w = radius;
    const double rim = std::sqrt(leaning * leaning + rounded * rounded);
    top = post.height * upright + radius * rim;
    top_rate = radius * leaning / rim - post.height * tilt;
    set_outline(post.opens ? panel.box : outline_at(panel, std::max(radius, least_outline_depth)));
    const double off = std::min(1.0, std::max({low, -high, 0.0}) / post.radius);
    grip = 1.0 - off * off;
    // A panel that ends before the edge's axis meets only its rounding. Then the edge counts as a post.
    const double opens =
        post.opens ? std::max(0.0, 1.0 - 2.0 * off) * open_side(w, stands, *post.opens) : 0.0;
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    // From the edge's axis to the middle, towards the side on which the edge is open.
    const double to_middle = opens < 0.0 ? -middle : middle;
    const double open_flank =
        half > 0.0 ? open_flank_factor((to_middle - radius) / half, edge_flank_factor) : post_flank;
    flank_low = flank_factor(-opens, open_flank);
    flank_high = flank_factor(opens, open_flank);
    along_factor = climbing_share((1.0 - std::abs(opens)) * tilt);  // a wall's edge is a wedge
    if (post.opens) set_faces(post, stands);
    const double slope_there = steepest * upright, cosine = 1.0 / std::sqrt(1.0 + slope_there * slope_there);
    steep_arc = slope_there * cosine * radius;
    rise_there = stretch * radius * cosine;
}

void Indentation::set_faces(const Post& post, const Placement& stands) {
    for (int k = 0; k < 2; ++k) {
        const Vec3 direction = stands.direction_from_own(post.along_face(k));
        const double e = direction.dot(into()), w = direction.dot(across());
        const double in_section = e - tilt * direction.dot(along());  // of the face with a plane of e and w
        face[k] = {e, w, w != 0.0 ? -in_section / std::abs(w) : infinity};
        const double slope = face[k].slope;
        if (is_nearly_parallel(face[k]) || slope > steepest) continue;
        const double turn = 1.0 + tilt * tilt + slope * slope;
        (w > 0.0 ? side_high : side_low) = {slope, w > 0.0 ? -turn : turn, -slope * tilt};
    }
}

namespace {

// Of a linear function over a range: its value is base + slope x.
Range linear(double base, double slope, const Range& x) {
    const double at_low = slope == 0.0 ? base : base + slope * x.low,
                 at_high = slope == 0.0 ? base : base + slope * x.high;
    return {std::min(at_low, at_high), std::max(at_low, at_high)};
}

Range extent(const Indentation& indentation, const Box& box, const Vec3& axis) {
    const double middle = (box.center - indentation.foot()).dot(axis), half = box.half.dot(axis.cwiseAbs());
    return {middle - half, middle + half};
}

// The part of the face or post that is before a range across.
Range before(const Indentation& indentation, const Range& w) {
    return {std::clamp(w.low, indentation.least_w, indentation.most_w),
            std::clamp(w.high, indentation.least_w, indentation.most_w)};
}

// Places along `into` of the post's axis at the heights of a box; of a face, of its top edge before the box.
Range middle_over(const Indentation& indentation, const Box& box) {
    if (indentation.is_face)
        return linear(indentation.tilt * indentation.top, indentation.edge_slope,
                      before(indentation, extent(indentation, box, indentation.across())));
    const Range l = extent(indentation, box, indentation.along());
    return linear(0.0, indentation.tilt,
                  {std::min(l.low, indentation.top), std::min(l.high, indentation.top)});
}

}  // namespace

double Indentation::deepest_place(const Panel& panel) const {
    return stretch * radius + middle_over(*this, panel.box).high;
}

double Indentation::beside() const {
    const Range tops = linear(top, top_slope, before(*this, {low, high}));
    const double below = is_face ? tops.low - ceiling : bottom - top;
    return std::max({beside_across(), bottom - tops.high, below});
}

bool Indentation::is_beyond(const Panel& panel) const {
    return extent(*this, panel.anchors, into()).high <
           middle_over(*this, panel.anchors).low - stretch * radius;
}

// From the post's displacement, its flanks, and the growth of the slope.
double Indentation::fastest_growth(const Panel& panel) const {
    return 2.0 + slope_at<double>(deepest_place(panel) - surface, per_reach).slope;
}

namespace {

// Greatest indentation at the distance `beside` from a post of at most this depth: the maximum of p - slope(p) beside
// over depths p. The slope is at most `most_slope`.
double most_drawn_in(double deepest, double beside, double reach, double most_slope) {
    const double slope = std::min(slope_at<double>(deepest, 1.0 / reach).slope, most_slope);
    const double by_deepest = deepest - slope * beside;
    if (beside <= reach) return by_deepest;
    const double further = std::sqrt(beside * beside - reach * reach);
    return deepest * further < reach * reach * least_slope ? by_deepest
                                                           : std::max(by_deepest, -least_slope * further);
}

struct BoxInIndentation {
    double outermost, depth, drawn_in;
};

BoxInIndentation box_in_indentation(const Indentation& indentation, const Box& box, bool hangs) {
    const double outermost = extent(indentation, box, indentation.into()).low + indentation.behind;
    const Range w = extent(indentation, box, indentation.across()),
                l = extent(indentation, box, indentation.along());
    const double deepest = indentation.stretch * indentation.radius + middle_over(indentation, box).high,
                 depth = deepest - indentation.surface;
    const Range tops = linear(indentation.top, indentation.top_slope, before(indentation, w));
    const double off = std::max({w.low - indentation.most_w, indentation.least_w - w.high, 0.0});
    // A face draws in what is or was above its top edge, and nothing beside its ends.
    if (indentation.is_face && (off > 0.0 || (l.high <= tops.low - at_edge && !hangs)))
        return {outermost, depth, -infinity};
    return {outermost, depth,
            most_drawn_in(depth, off + indentation.steeper * std::max(l.low - tops.high, 0.0),
                          indentation.length, flattest_face(indentation))};
}

}  // namespace

double most_inside(const Indentation& indentation, const Box& box, bool hangs) {
    const BoxInIndentation in = box_in_indentation(indentation, box, hangs);
    return indentation.surface + in.drawn_in - in.outermost;
}

bool spans(const Indentation& indentation, const Box& box, bool hangs) {
    return box_in_indentation(indentation, box, hangs).drawn_in > 0.0;
}

double gap_of(const Indentation& indentation, const TrussBlockState& nodes, const TrussBlock& trusses,
              std::size_t panel) {
    return simd.find_indentation_gap(
        indentation, {nodes.x.data(), nodes.y.data(), nodes.z.data(), nodes.force.data(),
                      trusses.height_above_edge.data(), trusses.panel.data(), static_cast<double>(panel)});
}

void follow_indentation(const Indentation& indentation, const Indentation& then, const TrussBlockState& nodes,
                        const TrussBlock& trusses, std::size_t panel, const BlockColumn& contact_gap,
                        const BlockColumn& least_facing, const BlockColumn& lags, NodeFaces& faces,
                        BlockContact& contact, BlockColumn& rank, BlockColumn& follows) {
    simd.find_indentation(
        indentation, then,
        {nodes.x.data(), nodes.y.data(), nodes.z.data(), nodes.force.data(), trusses.height_above_edge.data(),
         trusses.panel.data(), static_cast<double>(panel)},
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
