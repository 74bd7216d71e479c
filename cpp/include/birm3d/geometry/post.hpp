// A bollard: a round post with a flat top, standing on the ground at the origin of its own axes, axis +z. The
// solid goes on endlessly below z = 0: nothing is ever pushed out downwards.
#pragma once

#include <limits>

#include "birm3d/geometry/nearest.hpp"

namespace birm3d {

struct Post {
    // Refuses a radius that is not finite and > 0, and a height that is not > 0 (it may be infinite).
    explicit Post(double radius, double height = std::numeric_limits<double>::infinity());

    double radius;  // m
    double height;  // m
};

Nearest nearest(const Post& post, const Vec3& p);

}  // namespace birm3d
