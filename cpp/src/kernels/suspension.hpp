// Springs and dampers of wheels without mass.
//
// A sprung wheel that stands on the ground is compressed by c: fully extended, its lowest point would lie so far below
// the ground. The spring has the energy k c^2 / 2 and pushes with its derivative, k c along the vertical at that point.
// So it keeps the energy in any pose. The damper adds d dc/dt; together they never pull. Where the body rises faster
// than the damper lets the spring extend, the wheel carries nothing. The damper then takes what the spring loses.
//
// A beam axle has its springs inside of its wheels. r is the ratio of its stiffness against roll to that of springs at the
// wheels. With the mean m and half the difference d of the two c, its energy is k (m^2 + r d^2). An end that carries nothing
// hangs where that is least: then the other end has the stiffness 2 k r / (1 + r). Dampers do the same with the rates of m and
// d. Bump stops stand at the springs, sqrt(r) of the way from the middle of the axle to the wheels.
#pragma once

#include <vector>

#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/body_state.hpp"

namespace birm3d {

// Of one sprung wheel on the ground: both forces act upwards at `arm` from the mass centre, world axes.
struct SuspensionLoad {
    std::size_t wheel = 0;
    Vec3 arm = Vec3::Zero();  // m
    double spring = 0.0;      // N
    double damper = 0.0;      // N
};

bool has_springs(const Unit& unit);

// Lists the loads of all sprung wheels that are on the ground and have not given way. `motion`: that dampers see, world
// axes.
void find_suspension_loads(const Unit& unit, const BodyState& state, const Twist& motion, WheelSet given_way,
                           std::vector<SuspensionLoad>& loads);

// Energy in the springs less that at rest (J). Of the wheels that have given way nothing is left.
double spring_energy(const Unit& unit, const BodyState& state, WheelSet given_way);

}  // namespace birm3d
