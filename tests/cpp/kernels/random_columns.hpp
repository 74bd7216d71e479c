// Random columns of a block, and a comparison bit by bit, for tests of the loops of each instruction set.
#pragma once

#include <cstring>

#include "birm3d/base/block.hpp"
#include "geometry/random_points.hpp"

namespace birm3d {

inline void fill(laboratory::Random& random, BlockColumn& column, double middle, double spread) {
    for (double& value : column)
        value = random.within(middle - spread, middle + spread);
}

template <class T>
bool same_bits(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace birm3d
