// A wheel of a unit.
#pragma once

#include <cstddef>
#include <cstdint>

#include "birm3d/base/types.hpp"

namespace birm3d {

// A spring and a damper between the body and a wheel without mass. Both act along the vertical.
struct Suspension {
    double stiffness = 0.0;  // N/m; 0: the wheel is fixed to the body
    double damping = 0.0;    // N s/m
    double at_rest = 0.0;    // compression under the weight (m)
    double bump = 0.0;       // from there to the bump stop, which is rigid (m)
    // Stiffness of a beam axle against roll, over that of its springs at the wheels: they stand further inside. 1: no axle.
    double roll_ratio = 1.0;

    bool springs() const { return stiffness > 0.0; }
};

// A disc that rolls about the body's s axis; only its lowest point meets the ground. With a tread of some radius it is a
// torus, and a tilted wheel stands beside its plane.
struct Wheel {
    Vec3 center = Vec3::Zero();  // body axes (m)
    double radius = 0.0;         // m
    // Load on the ground at which springs and hangers give way (N). The wheel then carries nothing until the body has
    // come down by `travel` (m).
    double breakaway = infinity;
    double travel = 0.0;
    Suspension suspension{};  // `center` is where it holds the wheel at rest
    // After which a free wheel has turned 63 % of the way to its direction of travel (s). Infinite: it does not steer.
    double steering_time = infinity;
    double tread_radius = 0.0;  // of the tread's cross-section, at most `radius` (m)
    // Slip angle that has the same side force, per tilt: a tilted wheel rolls on a curve towards the side it leans to.
    double camber_ratio = 0.0;
    double rolling_resistance = 0.0;  // of a wheel that rolls, per load
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::size_t opposite = none;  // index of the wheel at the other end of its beam axle; set by its unit

    bool steers() const { return steering_time < infinity; }
};

// An end of a beam axle: how far it is compressed (m), and the opposite end; negative: above the ground.
struct AxleEnd {
    double own, other;

    // Does it carry load? The lower end of an axle does, and the other one down to where it hangs.
    bool carries(double roll_ratio) const {
        return own > (other > 0.0 ? (roll_ratio - 1.0) / (roll_ratio + 1.0) * other : 0.0);
    }
    AxleEnd opposite() const { return {other, own}; }
};

// From the mass centre to the lowest point of a wheel, for the body's rotation R; world axes (m). The wheel is pushed up
// by `raised` from where it is at rest (m).
Vec3 lowest_point(const Wheel& wheel, const Mat3& R, double raised);

// Wheels of a unit, one bit each: bit i is wheel i.
using WheelSet = std::uint64_t;
inline constexpr std::size_t most_breakaway_wheels = 64;
inline bool has_wheel(WheelSet wheels, std::size_t i) {
    return i < most_breakaway_wheels && ((wheels >> i) & 1U) != 0;
}

}  // namespace birm3d
