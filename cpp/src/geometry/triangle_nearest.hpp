// The point of a triangle that is nearest to another point, in plain numbers and selections, so that single
// points and block loops share it: the foot of the perpendicular if it lies inside, else the nearest point of the
// three edges.
#pragma once

#include <cstddef>

#include "birm3d/base/inline.hpp"

namespace birm3d {

// Parts of a triangle: itself, the edges from corner i to i + 1, the corners.
enum TrianglePart : std::size_t { inner = 0, edge_0 = 1, corner_0 = 4, part_count = 7 };

struct PlainTriangle {
    struct Side {
        double x, y, z;     // corner it begins at (m)
        double ex, ey, ez;  // to the next corner (m)
        double mx, my, mz;  // in the triangle's plane, outward, any length
        double per_square;  // 1 / e^2
    };
    Side side[3];
    double nx, ny, nz;  // unit
};

struct OnTriangle {
    double square;   // of the distance (m^2)
    double x, y, z;  // from the triangle's point to the other (m)
    double part;     // a TrianglePart; a number like the others, for selections
};

BIRM3D_INLINE OnTriangle nearest_on_side(const PlainTriangle::Side& s, double index, double x, double y,
                                         double z) {
    const double dx = x - s.x, dy = y - s.y, dz = z - s.z;
    const double along = (dx * s.ex + dy * s.ey + dz * s.ez) * s.per_square;
    const double not_below = along > 0.0 ? along : 0.0;
    const double u = not_below < 1.0 ? not_below : 1.0;
    const double wx = dx - u * s.ex, wy = dy - u * s.ey, wz = dz - u * s.ez;
    constexpr double edge = edge_0, corner = corner_0;
    const double next = index < 2.0 ? corner + 1.0 + index : corner;
    const double part = along >= 1.0 ? next : edge + index;
    return {wx * wx + wy * wy + wz * wz, wx, wy, wz, along <= 0.0 ? corner + index : part};
}

BIRM3D_INLINE OnTriangle nearer(const OnTriangle& a, const OnTriangle& b) {
    const bool second = b.square < a.square;
    OnTriangle out;
    out.square = second ? b.square : a.square;
    out.x = second ? b.x : a.x;
    out.y = second ? b.y : a.y;
    out.z = second ? b.z : a.z;
    out.part = second ? b.part : a.part;
    return out;
}

// How far the point is outside of one side, along the triangle's plane; only the sign counts.
BIRM3D_INLINE double beyond(const PlainTriangle::Side& s, double x, double y, double z) {
    return (x - s.x) * s.mx + (y - s.y) * s.my + (z - s.z) * s.mz;
}

// Signed distance from the triangle's own plane (m): no point of the triangle is nearer.
BIRM3D_INLINE double ahead_of(const PlainTriangle& t, double x, double y, double z) {
    return (x - t.side[0].x) * t.nx + (y - t.side[0].y) * t.ny + (z - t.side[0].z) * t.nz;
}

BIRM3D_INLINE OnTriangle nearest_on_plain(const PlainTriangle& t, double x, double y, double z) {
    const OnTriangle edge =
        nearer(nearer(nearest_on_side(t.side[0], 0.0, x, y, z), nearest_on_side(t.side[1], 1.0, x, y, z)),
               nearest_on_side(t.side[2], 2.0, x, y, z));
    const double b0 = beyond(t.side[0], x, y, z), b1 = beyond(t.side[1], x, y, z),
                 b2 = beyond(t.side[2], x, y, z);
    const double b01 = b0 > b1 ? b0 : b1, most = b01 > b2 ? b01 : b2;
    const double off = ahead_of(t, x, y, z);
    const bool above = most <= 0.0;
    OnTriangle out;
    out.square = above ? off * off : edge.square;
    out.x = above ? off * t.nx : edge.x;
    out.y = above ? off * t.ny : edge.y;
    out.z = above ? off * t.nz : edge.z;
    out.part = above ? static_cast<double>(inner) : edge.part;
    return out;
}

}  // namespace birm3d
