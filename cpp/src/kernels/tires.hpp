// Round tyres on the ground z = 0 (paper 5.2): where they touch it, and the friction they feel.
//
// A wheel is a disc about the body's s axis; the point that meets the ground is its lowest one, which moves
// with pitch and roll. Friction is against the ground in two rules:
//   slip (default)  across the wheel's plane only, continuous in the slip angle: the brush model
//                   F = mu N (1 - (1 - s)^3) for s = C tan(alpha) / (3 mu) < 1, mu N beyond,
//                   with C the cornering stiffness per normal load (Fiala 1954; Pacejka, Tire and Vehicle
//                   Dynamics, ch. 3). Along its plane a rolling wheel has its rolling resistance only. Of the friction mu N a share b
//                   may brake, against the velocity of the point of contact; sqrt(1 - b^2) of it steers (friction
//                   circle), and at b = 1 the locked wheel slides. A tilted wheel rolls as if it were turned to the
//                   side that it leans to, by `camber_ratio` of its tilt: camber thrust that never adds energy.
//                   On its side wall it has none.
//   skid            the paper's: nothing while the mass centre moves exactly along r, else mu N against its
//                   velocity.
// Both are reduced in proportion to the speed where they would otherwise reverse the sliding.
#pragma once

#include <span>

#include "birm3d/model/settings.hpp"
#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/body_state.hpp"
#include "birm3d/state/contacts.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Positions of a sprung wheel: extended as far as it goes, as under the weight, or at its bump stop.
enum class WheelAt { droop, rest, bump_stop };

// One contact for each wheel, whether it touches or not (normal +z, gap signed). Those that have given way are pushed up.
void find_tire_contacts(const Unit& unit, std::size_t body, const BodyState& state, WheelSet given_way,
                        WheelAt at, std::vector<RigidContact>& contacts);

// Can any wheel give way?
bool may_give_way(const Unit& unit);

// Updates the loads N of the wheels (N) by their normal impulses in a step of dt (s), impacts included. With the force F of a
// step, dN/dt = (F - N) / 10 ms. A rigid wheel stops in one step. Real springs and tyres take about 10 ms.
void follow_loads(double dt, std::span<const double> normal_impulses, std::span<double> loads);

// The wheels that give way under these loads.
WheelSet overloaded(const Unit& unit, std::span<const double> loads);

// The vehicle's present motion, and that at the end of the step of this half kick. With the latter, friction follows
// the trapezoid rule. For a nearly sticking wheel that would oscillate; then the present motion is used.
struct TireMotion {
    Twist now, at_end;
};

// Friction that goes with the normal impulses of the wheels (N s): linear and angular impulse about the mass
// centre, world axes. An impact's friction is as sudden as the impact. `steering_angle`: of the wheels that steer, to the
// left (rad); the paper's rule does not have it.
Wrench tire_friction(const Unit& unit, const Settings& settings, const BodyState& state,
                     double steering_angle, const TireMotion& motion,
                     std::span<const double> normal_impulses);

}  // namespace birm3d
