// A barrier: a surface, its friction, fixed to the ground. Its line runs along +y at heading 0, its traffic
// face looks to -x.
#pragma once

#include "birm3d/base/types.hpp"
#include "birm3d/geometry/half_space.hpp"

namespace birm3d {

struct Barrier {
    // origin: a point of the traffic face's foot (m). heading: turn of the barrier's line about z (rad).
    Barrier(double friction, const Vec3& origin, double heading);

    double friction;  // Coulomb coefficient vehicle-barrier (paper 5.4: 0.15 to 0.20 steel on concrete)
    Vec3 origin;      // m
    double heading;   // rad
    HalfSpace face;   // world axes
};

}  // namespace birm3d
