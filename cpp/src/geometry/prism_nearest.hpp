// Distance from a prism in plain numbers and selections, so that single points (Number: double) and rows of nodes
// (src/base/packet.hpp) share it.
//
// In the plane of the profile (x to the right, z up) the nearest edge gives a vector from the surface to the
// point; along y the ends add their part. |gap| is the length of the shortest such vector over the faces that
// are not covered; the number of edges that a line from the point along +x crosses gives the sign.
#pragma once

#include "base/select.hpp"
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
template <class Number>
struct NearestEdge {
    Number square = infinitely_far;  // of the distance (m^2)
    Number ahead = 0.0;              // of the edge's line, negative behind it (m)
    Number past = 0.0;               // past the edge's end, along (tx, tz) (m)
    Number tx = 1.0, tz = 0.0;       // of that edge
};

template <class Number>
BIRM3D_INLINE NearestEdge<Number> nearer_edge(const PrismEdge& edge, const Number& x, const Number& z,
                                              const NearestEdge<Number>& best) {
    const Number dx = x - edge.x, dz = z - edge.z;
    const Number along = dx * edge.tx + dz * edge.tz, ahead = dx * edge.tz - dz * edge.tx;
    const Number low = edge.low, high = edge.high, zero = 0.0;
    const Number not_below = where_above(along, low, along, low);
    const Number past = along - where_above(high, not_below, not_below, high);
    // On a corner the first of its two edges is the nearest, whatever rounding says.
    const Number least = tolerance::edge_radius * tolerance::edge_radius;
    const Number exact = ahead * ahead + past * past;
    const Number square = where_above(exact, least, exact, zero);
    const auto nearer = [&](const Number& own, const Number& other) {
        return where_above(best.square, square, own, other);
    };
    return {nearer(square, best.square), nearer(ahead, best.ahead), nearer(past, best.past),
            nearer(edge.tx, best.tx), nearer(edge.tz, best.tz)};
}

// Flips the sign where a line from the point along +x crosses the edge. Starting with +1 and after all edges: +1
// outside, -1 inside.
template <class Number>
BIRM3D_INLINE Number side_after_edge(const PrismEdge& edge, const Number& x, const Number& z,
                                     const Number& side) {
    const Number z_low = edge.z_low, z_high = edge.z_high;
    const Number crossing = edge.x + (z - edge.z) * edge.slope;
    const Number below_top = where_above(z_high, z, -1.0 * side, side);
    const Number beside = where_above(z_low, z, side, below_top);
    return where_above(crossing, x, beside, side);
}

// Vector from the nearest point of the surface, its square, and the normal of the face it lies on.
template <class Number>
struct FromSurface {
    Number square;
    Number x, y, z;
    Number nx, ny, nz;
};

// `past_end`: how far the point is beyond the nearer end, 0 between them (m).
template <class Number>
BIRM3D_INLINE FromSurface<Number> from_edge(const NearestEdge<Number>& edge, const Number& past_end) {
    return {edge.square + past_end * past_end,
            edge.ahead * edge.tz + edge.past * edge.tx,
            past_end,
            edge.past * edge.tz - edge.ahead * edge.tx,
            edge.tz,
            0.0,
            -1.0 * edge.tx};
}

// The face at one end: the inside of the profile, beside it its outline. `outline`: the nearest of all edges.
// `ahead`: of the end's plane, along +y; `normal`: +-1.
template <class Number>
BIRM3D_INLINE FromSurface<Number> nearer_end(const NearestEdge<Number>& outline, const Number& side,
                                             const Number& ahead, double normal,
                                             const FromSurface<Number>& best) {
    const Number zero = 0.0, own_normal = normal;
    const FromSurface<Number> rim = from_edge(outline, ahead);
    const Number square = where_above(side, zero, rim.square, ahead * ahead);
    const auto nearer = [&](const Number& own, const Number& other) {
        return where_above(best.square, square, own, other);
    };
    return {nearer(square, best.square), nearer(where_above(side, zero, rim.x, zero), best.x),
            nearer(ahead, best.y),       nearer(where_above(side, zero, rim.z, zero), best.z),
            nearer(zero, best.nx),       nearer(own_normal, best.ny),
            nearer(zero, best.nz)};
}

// `sign`: +1 outside, -1 inside the prism.
template <class Number>
BIRM3D_INLINE void signed_distance(const FromSurface<Number>& v, const Number& sign, Number& gap, Number& nx,
                                   Number& ny, Number& nz) {
    const Number least = tolerance::edge_radius, one = 1.0;
    const Number distance = square_root(v.square);
    const Number unit = sign / where_above(distance, least, distance, one);
    gap = sign * distance;
    nx = where_above(distance, least, v.x * unit, v.nx);
    ny = where_above(distance, least, v.y * unit, v.ny);
    nz = where_above(distance, least, v.z * unit, v.nz);
}

// The distance past the nearer of two ends, 0 between them (m).
template <class Number>
BIRM3D_INLINE Number past_ends(const Number& y, double low, double high) {
    const Number least = low, most = high;
    const Number not_below = where_above(y, least, y, least);
    return y - where_above(most, not_below, not_below, most);
}

// Beyond an end all is outside.
template <class Number>
BIRM3D_INLINE Number side_with_ends(const Number& side, const Number& past_end) {
    const Number zero = 0.0, outside = 1.0;
    return where_above(past_end, zero, outside, where_above(zero, past_end, outside, side));
}

}  // namespace birm3d
