// A barrier: a surface, its friction, fixed to the ground. Its line runs along +y at heading 0, its traffic
// face looks to -x.
#pragma once

#include <limits>

#include "birm3d/base/types.hpp"
#include "birm3d/geometry/surface.hpp"

namespace birm3d {

struct Barrier {
    // Flat wall. origin: a point of the traffic face's foot (m). heading: turn of the barrier's line about z
    // (rad). width, height: of the wall (m), may be infinite; its middle stands at the origin.
    Barrier(double friction, const Vec3& origin, double heading,
            double width = std::numeric_limits<double>::infinity(),
            double height = std::numeric_limits<double>::infinity());

    // Upright cylinder, taller than what meets it. origin: foot of its axis, on the barrier's line.
    static Barrier pole(double friction, const Vec3& origin, double heading, double radius);

    bool finite() const;
    Vec3 normal() const;  // of the barrier's line, towards the traffic

    double friction;  // Coulomb coefficient vehicle-barrier (paper 5.4: 0.15 to 0.20 steel on concrete)
    Vec3 origin;      // m
    double heading;   // rad
    double width;     // m
    double height;    // m
    Surface face;     // world axes
};

}  // namespace birm3d
