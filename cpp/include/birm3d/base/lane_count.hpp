// Trusses in a block, the unit of work of the kernels. Plain, like node_sums.hpp.
#pragma once

#include <cstddef>

// Helpers of lane loops must be compiled with the loop they stand in.
#if defined(__GNUC__)
#define BIRM3D_IN_LANE_LOOP inline __attribute__((always_inline))
#else
#define BIRM3D_IN_LANE_LOOP inline
#endif

namespace birm3d {

inline constexpr std::size_t lanes = 64;

}  // namespace birm3d
