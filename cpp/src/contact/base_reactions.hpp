// What holds the elements of a barrier that move at one end of the drift: friction of the ground and impulses of the pins on
// free-standing segments, the plastic moments of posts that yield (contact/post_tilting.hpp).
#pragma once

#include "contact/impulse_iteration.hpp"
#include "contact/rigid_contacts.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Is it a point where the rigid body meets a moving element?
bool pushes_moving_element(const RigidContact& contact);

// Does the rigid body meet a moving element?
bool meets_moving_element(const std::vector<RigidContact>& contacts);

// Finds ground friction and pin impulses, or the impulses of plastic moments, for the present impulses of
// `memory.kick.contacts` and `memory.kick.on_cores`. Stores them in `memory.kick` and `memory.segments.motions`. `state` has
// the elements' motions without any of these.
void find_base_reactions(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory);

// Sets the elements' motions to those found. One that friction or its plastic moment holds gets exactly zero velocity.
void move_elements(const Scene& scene, const KickMemory& memory, State& state);

// Appends rows of the pins between segments that move or are pushed, with the speeds that they were found to have.
// Returns how many.
std::size_t add_pin_rows(const Scene& scene, const State& state, const KickMemory& memory,
                         std::vector<RigidContact>& rows);

}  // namespace birm3d
