// Elements of a barrier that move: free-standing segments slide on the ground, posts that yield tilt about
// their centre of rotation. That is the foot, at the ground, or a point below it where the foundation turns.
//
// A free-standing segment moves along the ground and turns about the vertical; it neither tips nor leaves the ground.
// Its mass properties follow from the solid: section area times length times density, of what stands above z = 0.
//
// A post that yields turns about its centre of rotation, but not about its own axis. The moment that resists is constant
// and acts against the turning (rigid, perfectly plastic hinge): the post stands still until the load's moment exceeds it.
#pragma once

#include <array>

#include "birm3d/geometry/post.hpp"
#include "birm3d/geometry/prism.hpp"
#include "birm3d/model/vehicle.hpp"

namespace birm3d {

enum class SegmentJoint {
    pinned,  // neighbours are held together at the middle of their ends and turn freely about the vertical
    loose,   // nothing between them: they do not even touch each other
};

struct FreeStanding {
    double density = 2400.0;       // kg/m^3
    double ground_friction = 0.5;  // Coulomb coefficient
    SegmentJoint joint = SegmentJoint::pinned;
};

// Posts that yield, all alike.
struct YieldingPosts {
    double mass;            // kg
    double inertia;         // about a horizontal axis through the centre of rotation (kg m^2)
    double plastic_moment;  // of the tube, or that the foundation resists, about the centre of rotation (N m)
};

// An element that moves: a free-standing segment, or a post that yields. The origin of a post's `body` is its centre of rotation,
// and its inertia is about that. This point is fixed, so the inverse mass is zero. A post uses neither `mass_center_height` nor
// `corner`.
struct MovingElement {
    RigidBody body;             // own axes of the element, origin at the mass centre
    double mass_center_height;  // above the ground (m)
    double reach;        // of a moving point from the axis through the mass centre; of a post its height (m)
    double half_length;  // m
    double half_base;    // from the middle to the nearer edge of its base (m)
    std::array<Vec3, 4> corner;        // of its base, from the mass centre, own axes (m)
    double plastic_moment = infinity;  // of a post that yields (N m)

    double lying_tilt =
        0.0;  // tilt at which a post that yields lies on the ground: it turns no further (rad)

    bool tilts() const { return plastic_moment < infinity; }
};

// Refuses a density that is not > 0, and a prism without ends or top or with nothing above z = 0. The mass centre
// must stand above the origin of the prism, within 1e-9 m.
MovingElement segment_of(const Prism& prism, double density);

// Refuses posts without end, and numbers that are not > 0. `depth`: of the centre of rotation below the ground (m). A post lies
// on the ground at a tilt of 1.4 rad. One that turns about a deeper point does so where its top has come down to the ground.
MovingElement tilting_post(const Post& post, const YieldingPosts& posts, double depth = 0.0);

}  // namespace birm3d
