// Motion of one rigid body. Angular momentum rather than angular velocity: it is what torques change, and
// free flight leaves it alone however the body tumbles.
#pragma once

#include "birm3d/base/types.hpp"

namespace birm3d {

struct BodyState {
    Vec3 position = Vec3::Zero();          // mass centre, from the base of the scene (m)
    Quat orientation = Quat::Identity();   // body axes to world axes
    Vec3 velocity = Vec3::Zero();          // mass centre, world (m/s)
    Vec3 angular_momentum = Vec3::Zero();  // about the mass centre, world axes (kg m^2/s)
};

}  // namespace birm3d
