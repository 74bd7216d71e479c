// A wheel of a unit.
#pragma once

#include "birm3d/base/types.hpp"

namespace birm3d {

// A disc that rolls about the body's s axis; only its lowest point meets the ground.
struct Wheel {
    Vec3 center = Vec3::Zero();  // body axes (m)
    double radius = 0.0;         // m
};

}  // namespace birm3d
