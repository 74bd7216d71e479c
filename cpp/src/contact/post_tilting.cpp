#include "contact/post_tilting.hpp"

#include "contact/base_reactions.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

// Angular momentum of each post without its plastic moment (N m s).
void sum_momenta(const State& state, const KickMemory& memory, std::vector<Vec3>& momenta) {
    const std::size_t units = state.units.size();
    momenta.resize(state.moving_elements.size());
    for (std::size_t i = 0; i < momenta.size(); ++i)
        momenta[i] = state.moving_elements[i].angular_momentum +
                     tilting_part(state.moving_elements[i], memory.kick.on_cores[units + i].torque);
    for (const RigidContact& contact : memory.kick.contacts)
        if (pushes_moving_element(contact))
            momenta[contact.obstacle] +=
                tilting_part(state.moving_elements[contact.obstacle], wrench_on_other(contact).torque);
}

void set_body(const Scene& scene, const State& state, std::size_t post, bool is_held, KickMemory& memory) {
    ContactBody& body = memory.bodies[state.units.size() + post];
    body.inverse_inertia = is_held ? Mat3(Mat3::Zero())
                                   : inverse_inertia_of_post(scene.barrier->moving_elements[post].body,
                                                             state.moving_elements[post]);
}

}  // namespace

Vec3 plastic_impulse(const MovingElement& post, const BodyState& body, const Vec3& momentum, double time) {
    const double size = momentum.norm(), most = post.plastic_moment * time;
    if (size <= most || tilt_of(body) >= post.lying_tilt) return -momentum;
    return -most / size * momentum;
}

void find_plastic_moments(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory) {
    const std::size_t count = state.moving_elements.size();
    std::vector<Vec3>& momenta = memory.posts.momenta;
    sum_momenta(state, memory, momenta);
    memory.posts.angular_velocities.resize(count);
    memory.kick.on_base.assign(count, {});
    memory.kick.on_pins.assign(count, {});
    for (std::size_t i = 0; i < count; ++i) {
        const MovingElement& post = scene.barrier->moving_elements[i];
        Vec3& impulse = memory.kick.on_base[i].torque;
        impulse = plastic_impulse(post, state.moving_elements[i], momenta[i], by.time);
        memory.posts.angular_velocities[i] = post.body.inverse_inertia(0, 0) * (momenta[i] + impulse);
    }
}

void begin_holding_posts(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory) {
    memory.posts.held.resize(state.moving_elements.size());
    for (std::size_t i = 0; i < memory.posts.held.size(); ++i) {
        memory.posts.held[i] = by.from[state.units.size() + i].angular_velocity.isZero(0.0) ? 1 : 0;
        set_body(scene, state, i, memory.posts.held[i] != 0, memory);
    }
}

bool decide_yielding(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory) {
    // Relative change of an impulse that counts.
    constexpr double settled = 1e-6;
    std::vector<Vec3>& momenta = memory.posts.momenta;
    sum_momenta(state, memory, momenta);
    bool any = false;
    for (std::size_t i = 0; i < momenta.size(); ++i) {
        Vec3& impulse = memory.kick.on_base[i].torque;
        const Vec3 now =
            plastic_impulse(scene.barrier->moving_elements[i], state.moving_elements[i], momenta[i], by.time);
        const bool yields = now.squaredNorm() < momenta[i].squaredNorm();
        const bool was_held = memory.posts.held[i] != 0;
        const bool drives = !was_held && (momenta[i] + impulse).dot(impulse) > 0.0;
        const bool turns = !was_held && yields && (now - impulse).norm() > settled * now.norm();
        const bool is_held = was_held ? !yields : drives;
        if (is_held == was_held && !turns) continue;
        any = true;
        impulse = now;
        memory.posts.held[i] = is_held ? 1 : 0;
        set_body(scene, state, i, is_held, memory);
    }
    return any;
}

void free_posts(const Scene& scene, const State& state, KickMemory& memory) {
    for (std::size_t i = 0; i < state.moving_elements.size(); ++i)
        set_body(scene, state, i, false, memory);
}

void move_posts(const Scene& scene, const PostMemory& posts, State& state) {
    for (std::size_t i = 0; i < state.moving_elements.size(); ++i)
        state.moving_elements[i].angular_momentum =
            scene.barrier->moving_elements[i].body.inertia(0, 0) * posts.angular_velocities[i];
}

}  // namespace birm3d
