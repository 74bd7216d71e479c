// Sums over nodes, in eight columns that are added up at the end: a fixed order for any instruction set.
// Plain, because files that are compiled for several instruction sets include it (see src/base/packet.hpp).
#pragma once

#include "birm3d/base/inline.hpp"

namespace birm3d {

// Of eight columns.
BIRM3D_INLINE double packet_sum(const double* v) {
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

struct alignas(64) NodeSums {
    double force[8] = {};                                         // normal force (N)
    double moment_x[8] = {}, moment_y[8] = {}, moment_z[8] = {};  // flat surface: first moments of it (N m);
                                                                  // curved: torque (N m)
    double push_x[8] = {}, push_y[8] = {}, push_z[8] = {};        // curved surface: force (N)
    double stiffness[8] = {};                                     // curved surface: see SkinForces (1/s^2)
    double twice_work[8] = {}, twice_stored[8] = {};              // J
};

}  // namespace birm3d
