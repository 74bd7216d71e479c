// How near and how far the points of a rectangle in the plane of a profile are from its edges.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/prism_nearest.hpp"

namespace birm3d {

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

// Does a line from a point of the rectangle along +x cross the edge? `some`: it may.
enum class Crossing { none, some, all };

inline Crossing crossing_of(const PrismEdge& edge, const Rectangle& all) {
    if (!(all.z_low < edge.z_high && all.z_high >= edge.z_low)) return Crossing::none;
    const double a = edge.x + (all.z_low - edge.z) * edge.slope,
                 b = edge.x + (all.z_high - edge.z) * edge.slope;
    // A margin above all rounding errors.
    const double clear = 1e-9 * (1.0 + std::abs(a) + std::abs(b));
    if (std::max(a, b) < all.x_low - clear) return Crossing::none;
    const bool beside = all.z_low >= edge.z_low && all.z_high < edge.z_high;
    return beside && std::min(a, b) > all.x_high + clear ? Crossing::all : Crossing::some;
}

}  // namespace birm3d
