// Trusses in a block, the unit of work of the kernels.
#pragma once

#include <cstddef>

namespace birm3d {

inline constexpr std::size_t lanes = 64;

}  // namespace birm3d
