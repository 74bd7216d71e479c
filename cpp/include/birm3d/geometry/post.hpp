// A bollard: a round post with a flat top, standing on the ground at the origin of its own axes, axis +z. The
// solid goes on endlessly below z = 0: nothing is ever pushed out downwards.
#pragma once

#include <optional>

#include "birm3d/geometry/nearest.hpp"

namespace birm3d {

struct Post {
    // Refuses a radius that is not finite and > 0, a height that is not > 0 (it may be infinite), and a direction that is not
    // finite.
    explicit Post(double radius, double height = infinity, std::optional<double> opens = {});

    double radius;  // m
    double height;  // m
    // For the rounded upright edge of a wall: angle of the free quadrant's bisector from the own x axis (rad, counter-clockwise
    // seen from above). The wall fills the opposite quadrant.
    std::optional<double> opens;

    // Of such an edge: unit direction along its first or second face (k = 0, 1), own axes. The faces are square to each other, so
    // that it points into the block behind the other face.
    Vec3 along_face(int k) const;
};

Nearest nearest(const Post& post, const Vec3& p);

}  // namespace birm3d
