// Sums over nodes, in eight columns that are added up at the end: a fixed order for any instruction set.
// Plain, because files that are compiled for several instruction sets include it (see src/base/row.hpp).
#pragma once

namespace birm3d {

struct alignas(64) NodeSums {
    double force[8] = {};                                      // normal force (N)
    double force_x[8] = {}, force_y[8] = {}, force_z[8] = {};  // its first moments (N m)
    double twice_work[8] = {}, twice_stored[8] = {};           // J
};

}  // namespace birm3d
