#include "scene/bodies.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/integrate.hpp"

namespace birm3d {

const RigidBody& rigid_body(const Scene& scene, std::size_t body) {
    const std::size_t units = scene.vehicle->units.size();
    return body < units ? scene.vehicle->units[body].body : scene.barrier->moving_elements[body - units].body;
}

const BodyState& body_state(const State& state, std::size_t body) {
    const std::size_t units = state.units.size();
    return body < units ? state.units[body].body : state.moving_elements[body - units];
}

BodyState& body_state(State& state, std::size_t body) {
    const std::size_t units = state.units.size();
    return body < units ? state.units[body].body : state.moving_elements[body - units];
}

void list_body_states(const State& state, std::vector<BodyState>& bodies) {
    bodies.clear();
    for (std::size_t b = 0; b < body_count(state); ++b)
        bodies.push_back(body_state(state, b));
}

void kick_body(const Scene& scene, std::size_t body, const Wrench& impulse, State& state) {
    Wrench part = impulse;
    if (body >= state.units.size()) {
        if (scene.tilts()) {
            part = {Vec3::Zero(), tilting_part(body_state(state, body), impulse.torque)};
        } else {
            part.force.z() = 0.0;
            part.torque.x() = part.torque.y() = 0.0;
        }
    }
    kick(rigid_body(scene, body), part, body_state(state, body));
}

Vec3 tilting_part(const BodyState& post, const Vec3& torque) {
    const Vec3 axis = post.orientation * Vec3::UnitZ();
    return torque - axis.dot(torque) * axis;
}

Mat3 inverse_inertia_of_post(const RigidBody& body, const BodyState& post) {
    const Vec3 axis = post.orientation * Vec3::UnitZ();
    return body.inverse_inertia(0, 0) * (Mat3::Identity() - axis * axis.transpose());
}

double tilt_of(const Vec3& axis) {
    return std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
}

double tilt_of(const BodyState& post) {
    return tilt_of(Vec3(post.orientation * Vec3::UnitZ()));
}

int body_of_obstacle(const Scene& scene, std::size_t obstacle) {
    return obstacle < scene.moving_count() ? static_cast<int>(scene.vehicle->units.size() + obstacle) : -1;
}

double fastest_point(const MovingElement& element, const BodyState& body) {
    if (body.velocity.isZero(0.0) && body.angular_momentum.isZero(0.0)) return 0.0;
    return body.velocity.norm() + angular_velocity(element.body, body).norm() * element.reach;
}

double kinetic_energy_of(const Scene& scene, const State& state) {
    double sum = 0.0;
    for (std::size_t body = 0; body < body_count(state); ++body)
        sum += kinetic_energy(rigid_body(scene, body), body_state(state, body));
    return sum;
}

bool skin_touches_barrier(const Scene& scene, const UnitState& unit) {
    return std::any_of(unit.contact_loads.begin(), unit.contact_loads.end(), [&](const ContactLoad& contact) {
        return contact.obstacle != scene.ground && contact.normal_force > 0.0;
    });
}

}  // namespace birm3d
