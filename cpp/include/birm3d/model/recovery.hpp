// The unloading curve F = coefficient (d - d_r)^n of truss_law.hpp, as law, state and kernels share it.
// Plain, because files that are compiled for several instruction sets include it, for packets of eight.
#pragma once

#include "birm3d/base/inline.hpp"

namespace birm3d {

// The degree n of the curve of a truss with a recovery, and of Fig. 3's line. Nothing else states them.
inline constexpr int recovery_degree = 5, line_degree = 1;

// A recovery above this length stands for none: the truss unloads along Fig. 3's line (m).
inline constexpr double longest_recovery = 1e6;

// Coefficient of the curve of a truss that was never loaded: it is above any envelope (N/m^n).
inline constexpr double uncrushed_coefficient = 1e200;

// Does a truss of this recovery (m) unload along the curve, rather than along Fig. 3's line?
BIRM3D_INLINE constexpr bool has_recovery(double recovery) {
    return recovery <= longest_recovery;
}

// u^n by squares, as the kernel has it. power_in_turn() differs from it by rounding.
template <int n, class Number>
BIRM3D_INLINE constexpr Number power_by_squares(const Number& u) {
    static_assert(n > 0);
    if constexpr (n == 1) {
        return u;
    } else if constexpr (n % 2 == 1) {
        return power_by_squares<n - 1>(u) * u;
    } else {
        const Number root = power_by_squares<n / 2>(u);
        return root * root;
    }
}

// u^n, one factor after the other.
template <int n>
BIRM3D_INLINE constexpr double power_in_turn(double u) {
    static_assert(n > 0);
    double power = u;
    for (int factors = 1; factors < n; ++factors)
        power *= u;
    return power;
}

// Slope dF/dd = n F / u of unloading, where the force is F at u = d - d_r > 0 (N/m).
template <class Number>
BIRM3D_INLINE constexpr Number unloading_tangent(const Number& degree, const Number& force, const Number& u) {
    return degree * force / u;
}

}  // namespace birm3d
