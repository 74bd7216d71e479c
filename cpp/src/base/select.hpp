// Selections by which arithmetic is written that single numbers and packets of eight (src/base/packet.hpp) share. Plain, like
// node_sums.hpp.
#pragma once

#include <limits>

#include "birm3d/base/inline.hpp"

namespace birm3d {

inline constexpr double infinitely_far = std::numeric_limits<double>::infinity();  // m, m^2

// a > b ? yes : no
BIRM3D_INLINE double where_above(double a, double b, double yes, double no) {
    return a > b ? yes : no;
}

BIRM3D_INLINE double square_root(double a) {
    return __builtin_sqrt(a);
}

}  // namespace birm3d
