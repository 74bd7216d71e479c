#pragma once

#include <array>

#include "birm3d/base/block_size.hpp"

namespace birm3d {

// One number for each node of a block.
using BlockColumn = std::array<double, block_size>;

}  // namespace birm3d
