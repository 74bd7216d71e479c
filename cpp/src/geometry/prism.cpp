#include "birm3d/geometry/prism.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/error.hpp"
#include "geometry/prism_nearest.hpp"
#include "geometry/prism_range.hpp"

namespace birm3d {

namespace {

using Point = Eigen::Vector2d;

double cross(const Point& a, const Point& b) {
    return a.x() * b.y() - a.y() * b.x();
}

PrismEdge edge_between(const Point& from, const Point& to) {
    const Point d = to - from;
    const double length = d.norm();
    return {from.x(),
            from.y(),
            d.x() / length,
            d.y() / length,
            0.0,
            length,
            std::min(from.y(), to.y()),
            std::max(from.y(), to.y()),
            d.y() != 0.0 ? d.x() / d.y() : 0.0};
}

Point point_on(const PrismEdge& e, double u) {
    return {e.x + u * e.tx, e.z + u * e.tz};
}

double distance(const PrismEdge& e, const Point& p) {
    return std::sqrt(nearer_edge(e, p.x(), p.y(), NearestEdge<double>{}).square);
}

// Of two edges that do not cross.
double distance(const PrismEdge& a, const PrismEdge& b) {
    return std::min({distance(a, point_on(b, b.low)), distance(a, point_on(b, b.high)),
                     distance(b, point_on(a, a.low)), distance(b, point_on(a, a.high))});
}

// Does the middle of `b` lie behind the line of `a`?
bool behind(const PrismEdge& a, const PrismEdge& b) {
    return nearer_edge(a, point_on(b, 0.5 * b.high).x(), point_on(b, 0.5 * b.high).y(), NearestEdge<double>{})
               .ahead < 0.0;
}

bool cross_or_touch(const Point& a, const Point& b, const Point& c, const Point& d) {
    const double ab_c = cross(b - a, c - a), ab_d = cross(b - a, d - a);
    const double cd_a = cross(d - c, a - c), cd_b = cross(d - c, b - c);
    if (ab_c * ab_d > 0.0 || cd_a * cd_b > 0.0) return false;
    // On one line: do their rectangles overlap?
    return (a.cwiseMin(b).array() <= c.cwiseMax(d).array()).all() &&
           (c.cwiseMin(d).array() <= a.cwiseMax(b).array()).all();
}

std::string edge_name(std::size_t i) {
    return "edge " + std::to_string(i);
}

void require_simple(const Prism::Profile& p) {
    const std::size_t n = p.size();
    if (n < 3) refuse("profile", "3 points or more", static_cast<double>(n));
    for (std::size_t i = 0; i < n; ++i)
        if (!p[i].allFinite()) refuse("profile[" + std::to_string(i) + "]", "finite", "a number that is not");
    for (std::size_t i = 0; i < n; ++i) {
        const Point &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
        if (a == b) refuse("profile", "free of edges without length", edge_name(i));
        if (cross(b - a, c - b) == 0.0 && (b - a).dot(c - b) < 0.0)
            refuse("profile", "free of edges that fold back", edge_name((i + 1) % n));
        for (std::size_t k = i + 2; k < n && !(i == 0 && k == n - 1); ++k)
            if (cross_or_touch(a, b, p[k], p[(k + 1) % n]))
                refuse("profile", "free of edges that touch or cross", edge_name(i) + " and " + edge_name(k));
    }
}

double twice_area(const Prism::Profile& p) {
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i)
        sum += cross(p[i] - p[0], p[i + 1] - p[0]);
    return sum;
}

// Edges whose normals have a greater cosine than this belong to one corner. Their distance is no thickness.
constexpr double sides_of_corner = -0.5;

// Least distance of two edges that look away from each other and are no neighbours. `all`: the edges of the profile
// in order. A wedge has no such pair: the least depth of the profile behind an edge.
double least_thickness(const std::vector<PrismEdge>& all, const std::vector<bool>& covered) {
    const std::size_t n = all.size();
    double pairs = infinity, wedge = infinity;
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (covered[i]) continue;
        ++count;
        double depth = 0.0;
        for (std::size_t k = 0; k < n; ++k) {
            depth = std::max(depth, -nearer_edge(all[i], all[k].x, all[k].z, NearestEdge<double>{}).ahead);
            const bool neighbours = k == i || (k + 1) % n == i || (i + 1) % n == k;
            const bool away = all[i].tx * all[k].tx + all[i].tz * all[k].tz < sides_of_corner;
            if (!neighbours && !covered[k] && away && behind(all[i], all[k]) && behind(all[k], all[i]))
                pairs = std::min(pairs, distance(all[i], all[k]));
        }
        wedge = std::min(wedge, depth);
    }
    return pairs < infinity || count < 2 ? pairs : wedge;
}

Box bounds_of(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double y_low, double y_high) {
    const auto middle = [](double from, double to) {
        const bool ends = std::isfinite(from) && std::isfinite(to);
        return ends ? 0.5 * (from + to) : std::isfinite(from) ? from : std::isfinite(to) ? to : 0.0;
    };
    const auto half = [](double from, double to) {
        return std::isfinite(to - from) ? 0.5 * (to - from) : infinity;
    };
    return {{middle(low.x(), high.x()), middle(y_low, y_high), middle(low.y(), high.y())},
            {half(low.x(), high.x()), half(y_low, y_high), half(low.y(), high.y())}};
}

}  // namespace

struct Prism::Outline {
    std::vector<PrismEdge> edges, covered_edges;
    Eigen::Vector2d low, high;  // corners of the rectangle around it (m); the upper may be infinite
    double thickness = 0.0;     // m
};

const std::vector<PrismEdge>& Prism::edges() const {
    return outline_->edges;
}

const std::vector<PrismEdge>& Prism::covered_edges() const {
    return outline_->covered_edges;
}

std::shared_ptr<const Prism::Outline> Prism::outline_of(const Profile& profile,
                                                        const std::vector<std::size_t>& covered) {
    require_simple(profile);
    const std::size_t n = profile.size();
    std::vector<bool> is_covered(n, false);
    for (const std::size_t edge : covered) {
        if (edge >= n)
            refuse("cover", "edges of the profile, 0 to " + std::to_string(n - 1), edge_name(edge));
        is_covered[edge] = true;
    }
    // Counter-clockwise: the solid lies to the left of every edge.
    const bool reversed = twice_area(profile) < 0.0;
    std::vector<PrismEdge> all;
    for (std::size_t i = 0; i < n; ++i) {
        const Point &a = profile[i], &b = profile[(i + 1) % n];
        all.push_back(reversed ? edge_between(b, a) : edge_between(a, b));
    }
    auto outline = std::make_shared<Outline>();
    outline->low = outline->high = profile[0];
    for (std::size_t i = 0; i < n; ++i) {
        (is_covered[i] ? outline->covered_edges : outline->edges).push_back(all[i]);
        outline->low = outline->low.cwiseMin(profile[i]);
        outline->high = outline->high.cwiseMax(profile[i]);
    }
    outline->thickness = least_thickness(all, is_covered);
    return outline;
}

Prism::Prism(const Profile& profile, double y_low, double y_high, const Cover& cover)
    : Prism(outline_of(profile, cover.edges), y_low, y_high, cover.low_end, cover.high_end) {}

Prism::Prism(std::shared_ptr<const Outline> outline, double y_low, double y_high, bool cover_low,
             bool cover_high)
    : outline_(std::move(outline)),
      y_low_(y_low),
      y_high_(y_high),
      low_end_(std::isfinite(y_low) && !cover_low),
      high_end_(std::isfinite(y_high) && !cover_high) {
    if (!(y_low < y_high)) refuse("y_high", "above y_low = " + to_text(y_low), y_high);
    if (y_low == infinity || y_high == -infinity)
        refuse("y_low, y_high", "a range with finite places", y_low);
    if (outline_->edges.empty() && !low_end_ && !high_end_)
        refuse("cover", "one that leaves a surface", "every face");
    bounds_ = bounds_of(outline_->low, outline_->high, y_low_, y_high_);
}

Prism Prism::box(double thickness, double width, double height, double foot) {
    require_positive("thickness", thickness);
    require_not_negative("foot", foot);
    if (!(width > 0.0)) refuse("width", "> 0", width);
    if (!(height > 0.0)) refuse("height", "> 0", height);
    if (std::isfinite(height))
        return {{{0.0, -foot}, {thickness, -foot}, {thickness, height}, {0.0, height}},
                -0.5 * width,
                0.5 * width,
                Cover{.edges = {0}}};
    // Without a top, the two sides extend to infinity.
    auto outline = std::make_shared<Outline>();
    outline->edges = {{0.0, -foot, 0.0, -1.0, -infinity, 0.0, -foot, infinity, 0.0},
                      {thickness, -foot, 0.0, 1.0, 0.0, infinity, -foot, infinity, 0.0}};
    outline->covered_edges = {edge_between({0.0, -foot}, {thickness, -foot})};
    outline->low = {0.0, -foot};
    outline->high = {thickness, infinity};
    outline->thickness = thickness;
    return {std::move(outline), -0.5 * width, 0.5 * width, false, false};
}

Prism Prism::symmetric(const Profile& half_profile, double width, double foot) {
    require_not_negative("foot", foot);
    if (!(width > 0.0)) refuse("width", "> 0", width);
    if (half_profile.size() < 2)
        refuse("half_profile", "2 points or more", static_cast<double>(half_profile.size()));
    for (std::size_t i = 0; i < half_profile.size(); ++i) {
        const bool top = i + 1 == half_profile.size();
        const double half = half_profile[i].x();
        if (!(top ? half >= 0.0 : half > 0.0))
            refuse("half_profile[" + std::to_string(i) + "]'s half width", top ? ">= 0" : "> 0", half);
    }
    Profile profile;
    if (foot > 0.0) profile.emplace_back(half_profile[0].x(), half_profile[0].y() - foot);
    profile.insert(profile.end(), half_profile.begin(), half_profile.end());
    const std::size_t right = profile.size();
    for (std::size_t i = right; i-- > 0;)
        if (profile[i].x() > 0.0) profile.emplace_back(-profile[i].x(), profile[i].y());
    const std::size_t bottom = profile.size() - 1;
    return {profile, -0.5 * width, 0.5 * width, Cover{.edges = {bottom}}};
}

Prism Prism::with_covered_ends(bool low_end, bool high_end) const {
    return {outline_, y_low_, y_high_, low_end, high_end};
}

Nearest Prism::nearest(const Vec3& p) const {
    NearestEdge<double> face;
    double side = 1.0;
    for (const PrismEdge& edge : outline_->edges) {
        face = nearer_edge(edge, p.x(), p.z(), face);
        side = side_after_edge(edge, p.x(), p.z(), side);
    }
    NearestEdge<double> outline = face;
    for (const PrismEdge& edge : outline_->covered_edges) {
        outline = nearer_edge(edge, p.x(), p.z(), outline);
        side = side_after_edge(edge, p.x(), p.z(), side);
    }
    const double past_end = past_ends(p.y(), y_low_, y_high_);
    FromSurface<double> v = from_edge(face, past_end);
    if (low_end_) v = nearer_end(outline, side, p.y() - y_low_, -1.0, v);
    if (high_end_) v = nearer_end(outline, side, p.y() - y_high_, 1.0, v);
    Nearest out;
    signed_distance(v, side_with_ends(side, past_end), out.gap, out.normal.x(), out.normal.y(),
                    out.normal.z());
    return out;
}

double Prism::no_nearer(const Box& box) const {
    const Vec3 low = box.center - box.half, high = box.center + box.half;
    const Rectangle all{low.x(), high.x(), low.z(), high.z()};
    double least = infinity, side = 1.0;
    for (const auto* edges : {&outline_->edges, &outline_->covered_edges}) {
        for (const PrismEdge& edge : *edges) {
            least = std::min(least, distances(edge, all).least);
            side = side_after_edge(edge, box.center.x(), box.center.z(), side);
        }
    }
    return side > 0.0 ? std::sqrt(least) : 0.0;
}

double Prism::thickness() const {
    return low_end_ && high_end_ ? std::min(outline_->thickness, y_high_ - y_low_) : outline_->thickness;
}

}  // namespace birm3d
