// Distance from a prism in plain numbers and selections, so that single points and lane loops share it.
//
// In the plane of the profile (x to the right, z up) the nearest edge gives a vector from the surface to the
// point; along y the ends add their part. |gap| is the length of the shortest such vector over the faces that
// are not covered; the number of edges that a line from the point along +x crosses gives the sign.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "birm3d/base/lane_count.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d {

// One edge of the profile: the points (x, z) + u (tx, tz) with low <= u <= high, u in m. The solid lies to
// its left, the outward normal is (tz, -tx). Endless edges have a finite (x, z) too.
struct PrismEdge {
    double x, z;    // m
    double tx, tz;  // unit
    double low, high;
    double z_low, z_high;  // a line along x crosses the edge where z_low <= z < z_high
    double slope;          // dx/dz
};

// The nearest of some edges.
struct NearestEdge {
    double square = std::numeric_limits<double>::infinity();  // of the distance (m^2)
    double ahead = 0.0;                                       // of the edge's line, negative behind it (m)
    double past = 0.0;                                        // past the edge's end, along (tx, tz) (m)
    double tx = 1.0, tz = 0.0;                                // of that edge
};

BIRM3D_IN_LANE_LOOP NearestEdge nearer_edge(const PrismEdge& edge, double x, double z,
                                            const NearestEdge& best) {
    const double dx = x - edge.x, dz = z - edge.z;
    const double along = dx * edge.tx + dz * edge.tz, ahead = dx * edge.tz - dz * edge.tx;
    const double not_below = along > edge.low ? along : edge.low;
    const double past = along - (not_below < edge.high ? not_below : edge.high);
    // On a corner the first of its two edges is the nearest, whatever rounding says.
    constexpr double least = tolerance::edge_radius * tolerance::edge_radius;
    const double exact = ahead * ahead + past * past;
    const double square = exact > least ? exact : 0.0;
    const bool nearer = square < best.square;
    // No constructor is called: lane loops may call nothing that is not inlined.
    return {nearer ? square : best.square, nearer ? ahead : best.ahead, nearer ? past : best.past,
            nearer ? edge.tx : best.tx, nearer ? edge.tz : best.tz};
}

// +1 outside, -1 inside, once all edges have been asked, beginning with +1.
BIRM3D_IN_LANE_LOOP double side_after_edge(const PrismEdge& edge, double x, double z, double side) {
    const double crossing = edge.x + (z - edge.z) * edge.slope;
    const double below_top = z < edge.z_high ? -side : side;
    const double beside = z >= edge.z_low ? below_top : side;
    return x < crossing ? beside : side;
}

// Around some points, in the plane of the profile (m).
struct Rectangle {
    double x_low, x_high, z_low, z_high;
};

// Squares that the squares of the distances of all points of the rectangle from an edge lie between (m^2).
struct SquareRange {
    double least, most;
};

inline SquareRange distances(const PrismEdge& edge, const Rectangle& all) {
    const double x = 0.5 * (all.x_low + all.x_high) - edge.x, z = 0.5 * (all.z_low + all.z_high) - edge.z;
    const double half_x = 0.5 * (all.x_high - all.x_low), half_z = 0.5 * (all.z_high - all.z_low);
    const double ahead = std::abs(x * edge.tz - z * edge.tx), along = x * edge.tx + z * edge.tz;
    const double half_ahead = half_x * std::abs(edge.tz) + half_z * std::abs(edge.tx);
    const double half_along = half_x * std::abs(edge.tx) + half_z * std::abs(edge.tz);
    const auto past = [&](double half) {
        return std::max({0.0, edge.low - along - half, along - half - edge.high});
    };
    const double nearest = std::max(0.0, ahead - half_ahead), furthest = ahead + half_ahead;
    const double least = past(half_along), most = past(-half_along);
    return {nearest * nearest + least * least, furthest * furthest + most * most};
}

// Vector from the nearest point of the surface, its square, and the normal of the face it lies on.
struct FromSurface {
    double square;
    double x, y, z;
    double nx, ny, nz;
};

// `past_end`: how far the point is beyond the nearer end, 0 between them (m).
BIRM3D_IN_LANE_LOOP FromSurface from_edge(const NearestEdge& edge, double past_end) {
    return {edge.square + past_end * past_end,
            edge.ahead * edge.tz + edge.past * edge.tx,
            past_end,
            edge.past * edge.tz - edge.ahead * edge.tx,
            edge.tz,
            0.0,
            -edge.tx};
}

// The face at one end: the inside of the profile, beside it its outline. `outline`: the nearest of all edges.
// `ahead`: of the end's plane, along +y; `normal`: +-1.
BIRM3D_IN_LANE_LOOP FromSurface nearer_end(const NearestEdge& outline, double side, double ahead,
                                           double normal, const FromSurface& best) {
    const bool beside = side > 0.0;
    const FromSurface rim = from_edge(outline, ahead);
    const double square = beside ? rim.square : ahead * ahead;
    const bool nearer = square < best.square;
    const double x = beside ? rim.x : 0.0, z = beside ? rim.z : 0.0;
    FromSurface out;
    out.square = nearer ? square : best.square;
    out.x = nearer ? x : best.x;
    out.y = nearer ? ahead : best.y;
    out.z = nearer ? z : best.z;
    out.nx = nearer ? 0.0 : best.nx;
    out.ny = nearer ? normal : best.ny;
    out.nz = nearer ? 0.0 : best.nz;
    return out;
}

// `sign`: +1 outside, -1 inside the prism.
BIRM3D_IN_LANE_LOOP void signed_distance(const FromSurface& v, double sign, double& gap, double& nx,
                                         double& ny, double& nz) {
    const double distance = std::sqrt(v.square);
    const bool apart = distance > tolerance::edge_radius;
    const double unit = sign / (apart ? distance : 1.0);
    gap = sign * distance;
    nx = apart ? v.x * unit : v.nx;
    ny = apart ? v.y * unit : v.ny;
    nz = apart ? v.z * unit : v.nz;
}

}  // namespace birm3d
