// Motion of one rigid body. It has the angular momentum rather than the angular velocity, because torques change the
// momentum, and it is constant in free flight.
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
