// Posts that yield. A post stands still until the moment of its loads about its centre of rotation exceeds the plastic moment.
// From then on the plastic moment resists the tilting.
// Like Coulomb friction it is a limited impulse that never reverses the motion, found at the end of each half kick.
//
// Where the rigid core meets a post, the impulse depends on whether the post stands still. One that does is fixed for the
// solver, one that yields is a free body under the known impulse of its plastic moment. Which posts yield is found iteratively.
// An impact has no duration, so that a plastic moment has no impulse in it.
#pragma once

#include "contact/impulse_iteration.hpp"

namespace birm3d {

// Impulse of the plastic moment within `time` on a post of the angular momentum `momentum` (N m s). Unlimited where the post
// lies on the ground.
Vec3 plastic_impulse(const MovingElement& post, const BodyState& body, const Vec3& momentum, double time);

// Finds the impulses of the plastic moments for the present impulses of `memory.kick.contacts` and `memory.kick.on_cores`.
// Stores them in `memory.kick.on_base`, and the angular velocities in `memory.posts.angular_velocities`.
void find_plastic_moments(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory);

// Posts that stood still before the kick are held at first. Sets `memory.posts.held` and the bodies of the solver.
void begin_holding_posts(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory);

// After the solver: a held post yields where the moment exceeds the plastic one. A post that yields is held where the plastic
// moment would drive it. Sets the bodies and the impulses anew. Did any change?
bool decide_yielding(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory);

// Makes all posts free bodies of the solver again.
void free_posts(const Scene& scene, const State& state, KickMemory& memory);

// Sets the posts' motions to those found. A post that its moment holds gets exactly zero velocity.
void move_posts(const Scene& scene, const PostMemory& posts, State& state);

}  // namespace birm3d
