#pragma once

#include <cmath>

#include "birm3d/base/inline.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d {

// Of a point in the post's own axes. Plain numbers and selections, so that block loops can use it.
//
//   outside: distance to the side, the top disc or the rim between them, whichever is nearest;
//   inside: depth below the side or below the top, whichever is smaller.
// On the axis the normal is +x by convention. On the rim the normal is that of the side or of the top.
BIRM3D_INLINE void nearest_of_post(double radius, double height, double x, double y, double z, double& gap,
                                   double& nx, double& ny, double& nz) {
    const double square = x * x + y * y;
    const bool off_axis = square > tolerance::least_square;
    const double from_axis = std::sqrt(square);
    const double per_radial = 1.0 / (off_axis ? from_axis : 1.0);
    const double ex = off_axis ? x * per_radial : 1.0, ey = off_axis ? y * per_radial : 0.0;
    const double side = from_axis - radius, top = z - height;
    const double out_side = side > 0.0 ? side : 0.0, out_top = top > 0.0 ? top : 0.0;
    const double outside = std::sqrt(out_side * out_side + out_top * out_top);
    const double inside = side > top ? side : top;
    const bool rounded = outside > tolerance::edge_radius;
    const double per_outside = 1.0 / (rounded ? outside : 1.0);
    const double of_side = rounded ? out_side * per_outside : (side > top ? 1.0 : 0.0);
    nx = of_side * ex;
    ny = of_side * ey;
    nz = rounded ? out_top * per_outside : (side > top ? 0.0 : 1.0);
    gap = inside > 0.0 ? outside : inside;
}

}  // namespace birm3d
