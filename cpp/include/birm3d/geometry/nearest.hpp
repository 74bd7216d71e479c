// The answer every barrier shape gives about a point.
#pragma once

#include "birm3d/base/types.hpp"

namespace birm3d {

// For a point p, p - gap * normal is the nearest point of the surface. The normal is the gradient of the gap.
struct Nearest {
    double gap;   // signed distance of the point (m), negative inside
    Vec3 normal;  // outward, unit
};

}  // namespace birm3d
