#include <algorithm>
#include <cmath>
#include <utility>

#include "birm3d/base/tolerances.hpp"
#include "geometry/prism_nearest.hpp"
#include "kernels/detect.hpp"

namespace birm3d {

namespace {

// In the plane of the profile, x and z.
struct Flat {
    double x, z;
};

double dot(const Flat& a, const Flat& b) {
    return a.x * b.x + a.z * b.z;
}

Flat tangent(const PrismEdge& e) {
    return {e.tx, e.tz};
}

Flat normal(const PrismEdge& e) {
    return {e.tz, -e.tx};
}

Flat from(const PrismEdge& e, double x, double z) {
    return {x - e.x, z - e.z};
}

// Of a linear function over a box: its value in the middle and how far it spreads to either side.
struct Spread {
    double middle, reach;
    double least() const { return middle - reach; }
    double most() const { return middle + reach; }
};

struct PlacedBox {
    const Mat3& rotation;  // body axes to own
    const Vec3& half;      // m, along the body's axes
    Vec3 center;           // own axes (m)

    double reach(double x, double y, double z) const {
        double sum = 0.0;
        for (int k = 0; k < 3; ++k)
            sum += std::abs(x * rotation(0, k) + y * rotation(1, k) + z * rotation(2, k)) * half[k];
        return sum;
    }
    // Of the coordinate along a direction, from the edge's own point.
    Spread along(const Flat& direction, const PrismEdge& edge) const {
        return {dot(direction, from(edge, center.x(), center.z())), reach(direction.x, 0.0, direction.z)};
    }
};

// Lowest and highest place of an edge along a direction, from the face's own point (m).
std::pair<double, double> extent(const PrismEdge& edge, const Flat& direction, const PrismEdge& face) {
    const double slope = dot(direction, tangent(edge)), at = dot(direction, from(face, edge.x, edge.z));
    const double a = slope != 0.0 ? at + slope * edge.low : at;  // endless edges: not 0 times infinity
    const double b = slope != 0.0 ? at + slope * edge.high : at;
    return {std::min(a, b), std::max(a, b)};
}

bool behind(const PrismEdge& edge, const PrismEdge& face) {
    return extent(edge, normal(face), face).second <= 0.0;
}

// Is every point of the box at least as far from the edge as `factor` times its distance ahead of the face?
// The distance from an edge is a convex function, so its tangent plane in the middle of the box lies below it.
bool farther(const PlacedBox& box, const PrismEdge& edge, const PrismEdge& face, double ahead,
             double factor) {
    const FromSurface<double> v =
        from_edge(nearer_edge(edge, box.center.x(), box.center.z(), NearestEdge<double>{}), 0.0);
    const double distance = std::sqrt(v.square);
    if (!(distance > 0.0)) return false;
    const Flat n = normal(face);
    const double reach = box.reach(v.x / distance - factor * n.x, 0.0, v.z / distance - factor * n.z);
    return distance - factor * ahead - reach >= 0.0;
}

// Is the edge outside the rectangle that the box sweeps when it moves straight onto the face?
bool beside_path(const PrismEdge& edge, const PrismEdge& face, const Spread& along, const Spread& ahead) {
    const auto [u_low, u_high] = extent(edge, tangent(face), face);
    if (u_high <= along.least() || u_low >= along.most()) return true;
    const auto [n_low, n_high] = extent(edge, normal(face), face);
    return n_high <= std::min(ahead.least(), 0.0) || n_low >= std::max(ahead.most(), 0.0);
}

// Is every point of the box at least as far from the plane of the end as `factor` times its distance ahead?
bool end_is_farther(const PlacedBox& box, double end, double outward, const PrismEdge& face, double ahead,
                    double factor) {
    const Flat n = normal(face);
    const double reach = box.reach(-factor * n.x, -outward, -factor * n.z);
    return outward * (end - box.center.y()) - factor * ahead - reach >= 0.0;
}

// Is the face the nearest surface for every point of the box? All points must project onto the face, and no other
// edge may be nearer. In front of the face, edges behind its plane are never nearer. Covered edges are no surface,
// but must not lie between.
bool is_nearest_everywhere(const Prism& prism, const PrismEdge& face, const PlacedBox& box) {
    const Spread along = box.along(tangent(face), face);
    if (along.least() < face.low || along.most() > face.high) return false;
    const Spread y{box.center.y(), box.reach(0.0, 1.0, 0.0)};
    if (y.least() < prism.y_low() || y.most() > prism.y_high()) return false;
    const Spread ahead = box.along(normal(face), face);
    const bool before = ahead.most() > 0.0, inside = ahead.least() < 0.0;
    bool all_behind = true;
    for (const PrismEdge& edge : prism.edges()) {
        if (&edge == &face) continue;
        const bool edge_behind = behind(edge, face);
        all_behind = all_behind && edge_behind;
        if (before && !edge_behind && !farther(box, edge, face, ahead.middle, 1.0)) return false;
        if (inside && !farther(box, edge, face, ahead.middle, -1.0)) return false;
    }
    for (const PrismEdge& edge : prism.covered_edges()) {
        all_behind = all_behind && behind(edge, face);
        if (!beside_path(edge, face, along, ahead)) return false;
    }
    for (const double factor : {1.0, -1.0}) {
        if (!(factor > 0.0 ? before && !all_behind : inside)) continue;
        if (prism.low_end_is_surface() &&
            !end_is_farther(box, prism.y_low(), -1.0, face, ahead.middle, factor))
            return false;
        if (prism.high_end_is_surface() &&
            !end_is_farther(box, prism.y_high(), 1.0, face, ahead.middle, factor))
            return false;
    }
    return true;
}

}  // namespace

std::optional<HalfSpace> flat_part(const Shape& shape, const Placement& now, const Box& box) {
    if (const auto* plane = std::get_if<HalfSpace>(&shape)) return now.plane_from_own(*plane);
    const auto* prism = std::get_if<Prism>(&shape);
    if (!prism) return std::nullopt;
    const PlacedBox placed{now.rotation, box.half, now.to_own(box.center)};
    // What is nearest everywhere is nearest to the middle.
    const PrismEdge* face = nullptr;
    NearestEdge<double> nearest;
    for (const PrismEdge& edge : prism->edges()) {
        const NearestEdge<double> n = nearer_edge(edge, placed.center.x(), placed.center.z(), nearest);
        if (n.square < nearest.square) face = &edge;
        nearest = n;
    }
    if (!face || nearest.past != 0.0 || !is_nearest_everywhere(*prism, *face, placed)) return std::nullopt;
    const Flat n = normal(*face);
    return now.plane_from_own({{n.x, 0.0, n.z}, n.x * face->x + n.z * face->z});
}

bool is_behind(const HalfSpace& plane, const Shape& shape, const Placement& now) {
    const Box box = bounds(shape);
    const Vec3 normal = now.direction_to_own(plane.normal);
    // Below this, a part of a normal is rounding: an upright plane has posts behind it that go down endlessly.
    constexpr double none = 1e-9;
    double ahead = plane.gap(now.from_own(box.center));
    for (int k = 0; k < 3; ++k)
        if (std::abs(normal[k]) > none) ahead += std::abs(normal[k]) * box.half[k];
    return ahead <= tolerance::behind_plane;
}

}  // namespace birm3d
