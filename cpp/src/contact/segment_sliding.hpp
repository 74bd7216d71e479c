// What the ground and the pins do to free-standing segments at one end of the drift, on top of what pushes them.
#pragma once

#include "contact/impulse_iteration.hpp"
#include "contact/rigid_contacts.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Does the rigid body meet a segment?
bool meets_segments(const std::vector<RigidContact>& contacts);

// Finds frictions and pins with the present impulses of `memory.kick.contacts` and `memory.kick.on_cores`, to
// `memory.kick` and `memory.segment_motions`. `state` has the segments' motions without any of these.
void rub_on_ground(const Scene& scene, const KickedBy& by, const State& state, KickMemory& memory);

// Segments as they move with all that was found. What friction holds is at rest but for rounding; then it is at rest.
void move_segments(const Scene& scene, const KickMemory& memory, State& state);

// Appends rows of the pins between segments that move or are pushed, with the speeds that they were found to have.
// Returns how many.
std::size_t add_pin_rows(const Scene& scene, const State& state, const KickMemory& memory,
                         std::vector<RigidContact>& rows);

}  // namespace birm3d
