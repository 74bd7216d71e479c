// Free-standing segments of a barrier: solids that slide on the ground.
//
// A segment moves along the ground and turns about the vertical; it neither tips nor leaves the ground. Its mass
// properties follow from the solid: section area times length times density, of what stands above z = 0.
#pragma once

#include <array>

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

struct Segment {
    RigidBody body;              // own axes of the element, origin at the mass centre
    double mass_center_height;   // above the ground (m)
    double half_length;          // m
    double half_base;            // from the middle to the nearer edge of its base (m)
    std::array<Vec3, 4> corner;  // of its base, from the mass centre, own axes (m)
};

// Refuses a density that is not > 0, and a prism without ends or top or with nothing above z = 0. The mass centre
// must stand above the origin of the prism, within 1e-9 m.
Segment segment_of(const Prism& prism, double density);

}  // namespace birm3d
