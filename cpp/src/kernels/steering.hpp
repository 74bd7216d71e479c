// Wheels whose steering is free: they castor into the direction in which they travel.
//
// Nobody holds the steering wheel of a vehicle in a test, or of one whose driver is hit. The side force of a steered
// tyre acts behind its kingpin, and turns it until the force is gone. Inertia, friction of the steering gear and power
// steering delay that: by a tenth of a second in light vehicles, by half a second in trucks. So the angle d of the wheels
// follows the travel angle b of their centres with the lag T of a first order:
//     d' = (b - d) / T,   |d| <= the stops.
// A tie rod couples the wheels of a unit: they share one angle, and b is their mean, weighted by what they carry.
#pragma once

#include <span>

#include "birm3d/model/vehicle.hpp"

namespace birm3d {

bool steers(const Unit& unit);

// The steering angle (rad, to the left) after dt, under the impulses with which the wheels stand on the ground.
// `motion`: of the unit in between, world axes. Wheels that carry nothing, or roll backwards, do not turn the steering.
double steered(const Unit& unit, const Quat& orientation, const Twist& motion, double angle, double dt,
               std::span<const double> normal_impulses);

}  // namespace birm3d
