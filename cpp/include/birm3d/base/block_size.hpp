#pragma once

#include <cstddef>

namespace birm3d {

// Nodes, each with its truss, in a block. A block is what the kernels work on at a time.
inline constexpr std::size_t block_size = 64;

}  // namespace birm3d
