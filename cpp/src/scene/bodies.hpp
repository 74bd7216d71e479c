// The moving bodies of a scene by index: the vehicle's units, then the elements of the barrier that move.
#pragma once

#include <vector>

#include "birm3d/scene/scene.hpp"

namespace birm3d {

inline std::size_t body_count(const State& state) {
    return state.units.size() + state.moving_elements.size();
}
const RigidBody& rigid_body(const Scene& scene, std::size_t body);
const BodyState& body_state(const State& state, std::size_t body);
BodyState& body_state(State& state, std::size_t body);
// Of all of them.
void list_body_states(const State& state, std::vector<BodyState>& bodies);

// impulse: linear and angular about the body's mass centre, world axes (N s, N m s). The ground takes the vertical
// impulse and the tipping moment on a free-standing segment. On a post that yields only the tilting moment acts.
void kick_body(const Scene& scene, std::size_t body, const Wrench& impulse, State& state);

// Index of the body of an obstacle, or -1 if the obstacle is fixed.
int body_of_obstacle(const Scene& scene, std::size_t obstacle);

// The part of a torque that tilts a post: square to its own axis.
Vec3 tilting_part(const BodyState& post, const Vec3& torque);

// Of a post about its centre of rotation, world axes: the same about all axes that are square to its own, and zero about
// that (1/(kg m^2)).
Mat3 inverse_inertia_of_post(const RigidBody& body, const BodyState& post);

// Angle of a post's own axis to the vertical (rad). `axis`: unit vector along it, upwards.
double tilt_of(const Vec3& axis);
double tilt_of(const BodyState& post);

// Fastest any point of a moving element moves (m/s).
double fastest_point(const MovingElement& element, const BodyState& body);

// Of all bodies (J).
double kinetic_energy_of(const Scene& scene, const State& state);

// Does any node of the unit push on the barrier?
bool skin_touches_barrier(const Scene& scene, const UnitState& unit);

}  // namespace birm3d
