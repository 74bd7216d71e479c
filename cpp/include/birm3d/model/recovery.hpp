// These are numbers of the unloading curve (truss_law.hpp). Kernels include this header, as it defines no symbols.
#pragma once

namespace birm3d {

// The degree n of the curve of a truss with a recovery, and of Fig. 3's line.
inline constexpr double recovery_degree = 5.0, line_degree = 1.0;

// A recovery above this length stands for none: the truss unloads along Fig. 3's line (m).
inline constexpr double longest_recovery = 1e6;

// Coefficient of the curve of a truss that was never loaded: it is above any envelope (N/m^5).
inline constexpr double uncrushed_coefficient = 1e200;

}  // namespace birm3d
