// Sums over nodes, in eight columns that are added up at the end: a fixed order for any instruction set.
// Plain, because files that are compiled for several instruction sets include it (see src/base/row.hpp).
#pragma once

namespace birm3d {

struct alignas(64) NodeSums {
    double force[8] = {};                                         // normal force (N)
    double moment_x[8] = {}, moment_y[8] = {}, moment_z[8] = {};  // flat surface: first moments of it (N m);
                                                                  // curved: torque (N m)
    double push_x[8] = {}, push_y[8] = {}, push_z[8] = {};        // curved surface: force (N)
    double twice_work[8] = {}, twice_stored[8] = {};              // J
};

}  // namespace birm3d
