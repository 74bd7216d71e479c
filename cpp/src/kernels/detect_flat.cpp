#include <algorithm>
#include <cmath>

#include "birm3d/kernels/detect.hpp"

namespace birm3d {

namespace {

// Of a linear function over a box: values at the middle and how far they spread to either side.
struct Spread {
    double middle, reach;
    double least() const { return middle - reach; }
    double most() const { return middle + reach; }
};

struct PlacedBox {
    const Placement& now;
    const Box& box;  // body axes
    Vec3 center;     // own axes

    // Of direction . p, p in own axes.
    Spread along(const Vec3& direction) const {
        return {direction.dot(center), now.reach(box.half, direction)};
    }
};

Vec3 tangent(const PrismEdge& e) {
    return {e.tx, 0.0, e.tz};
}

Vec3 normal(const PrismEdge& e) {
    return {e.tz, 0.0, -e.tx};
}

Vec3 point_on(const PrismEdge& e, double u) {
    return Vec3(e.x, 0.0, e.z) + u * tangent(e);
}

// Is the edge with both ends at or behind the plane normal . p = offset? Endless ones only if parallel to it.
bool behind(const PrismEdge& edge, const Vec3& normal, double offset) {
    const double slope = normal.dot(tangent(edge)), at = normal.dot(point_on(edge, 0.0)) - offset;
    const double low = slope != 0.0 ? at + slope * edge.low : at;
    const double high = slope != 0.0 ? at + slope * edge.high : at;
    return std::max(low, high) <= 0.0;
}

// Is every point p of the box at least as far from the edge as factor * (normal . p - offset)? The distance
// from an edge is a convex function of p, so its tangent plane at the middle of the box lies below it.
bool farther(const PlacedBox& box, const PrismEdge& edge, const Vec3& normal, double offset, double factor) {
    const NearestEdge n = nearer_edge(edge, box.center.x(), box.center.z(), {});
    const double distance = std::sqrt(n.square);
    if (!(distance > 0.0)) return false;
    const Vec3 gradient =
        Vec3(n.ahead * n.tz + n.past * n.tx, 0.0, n.past * n.tz - n.ahead * n.tx) / distance;
    const double middle = distance - factor * (normal.dot(box.center) - offset);
    return middle - box.now.reach(box.box.half, gradient - factor * normal) >= 0.0;
}

// Lies the edge, in the coordinates along the face and ahead of it, beside the rectangle that is swept when
// the box moves onto the face?
bool beside_way(const PrismEdge& edge, const PrismEdge& face, const Spread& along, const Spread& ahead) {
    const double from = std::min(ahead.least(), 0.0), to = std::max(ahead.most(), 0.0);
    const auto extent = [&](const Vec3& direction, double origin) {
        const double slope = direction.dot(tangent(edge)), at = direction.dot(point_on(edge, 0.0)) - origin;
        const double a = slope != 0.0 ? at + slope * edge.low : at;
        const double b = slope != 0.0 ? at + slope * edge.high : at;
        return std::pair(std::min(a, b), std::max(a, b));
    };
    const auto [u_low, u_high] = extent(tangent(face), tangent(face).dot(point_on(face, 0.0)));
    const auto [n_low, n_high] = extent(normal(face), normal(face).dot(point_on(face, 0.0)));
    return u_high <= along.least() || u_low >= along.most() || n_high <= from || n_low >= to;
}

bool is_nearest_everywhere(const Prism& prism, const PrismEdge& face, const PlacedBox& box) {
    const Vec3 n = normal(face), t = tangent(face);
    const double offset = n.dot(point_on(face, 0.0)), start = t.dot(point_on(face, 0.0));
    Spread along = box.along(t);
    along.middle -= start;
    if (along.least() < face.low || along.most() > face.high) return false;
    Spread ahead = box.along(n);
    ahead.middle -= offset;
    const Spread y = box.along(Vec3::UnitY());
    if (y.least() < prism.y_low() || y.most() > prism.y_high()) return false;
    bool all_behind = true;
    for (const PrismEdge& edge : prism.edges()) {
        if (&edge == &face) continue;
        const bool edge_behind = behind(edge, n, offset);
        all_behind = all_behind && edge_behind;
        // In front of the face nothing behind its plane can be nearer.
        if (ahead.most() > 0.0 && !edge_behind && !farther(box, edge, n, offset, 1.0)) return false;
        if (ahead.least() < 0.0 && !farther(box, edge, n, offset, -1.0)) return false;
    }
    for (const PrismEdge& edge : prism.covered_edges()) {
        all_behind = all_behind && behind(edge, n, offset);
        if (!beside_way(edge, face, along, ahead)) return false;
    }
    // Ends: the distance from their planes against the distance from the face.
    const auto end_is_farther = [&](double end, double outward, double factor) {
        const double middle = outward * (end - box.center.y()) - factor * ahead.middle;
        return middle - box.now.reach(box.box.half, outward * Vec3::UnitY() + factor * n) >= 0.0;
    };
    const bool in_front = ahead.most() > 0.0 && !all_behind, inside = ahead.least() < 0.0;
    for (const double factor : {1.0, -1.0}) {
        if (!(factor > 0.0 ? in_front : inside)) continue;
        if (prism.low_end_is_surface() && !end_is_farther(prism.y_low(), -1.0, factor)) return false;
        if (prism.high_end_is_surface() && !end_is_farther(prism.y_high(), 1.0, factor)) return false;
    }
    return true;
}

}  // namespace

std::optional<HalfSpace> flat_part(const Shape& shape, const Placement& now, const Box& box) {
    if (const auto* plane = std::get_if<HalfSpace>(&shape)) return now.plane_from_own(*plane);
    const auto* prism = std::get_if<Prism>(&shape);
    if (!prism) return std::nullopt;
    const PlacedBox placed{now, box, now.to_own(box.center)};
    // What is nearest everywhere is nearest to the middle.
    const PrismEdge* face = nullptr;
    NearestEdge nearest;
    for (const PrismEdge& edge : prism->edges()) {
        const NearestEdge n = nearer_edge(edge, placed.center.x(), placed.center.z(), nearest);
        if (n.square < nearest.square) face = &edge;
        nearest = n;
    }
    if (!face || nearest.past != 0.0 || !is_nearest_everywhere(*prism, *face, placed)) return std::nullopt;
    return now.plane_from_own({normal(*face), normal(*face).dot(point_on(*face, 0.0))});
}

}  // namespace birm3d
