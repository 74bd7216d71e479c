// What a unit, a group of its blocks and one block can meet: each list is chosen from the one before it.
#pragma once

#include "contact/contact_pass.hpp"
#include "contact/trial.hpp"

namespace birm3d {

enum class Reach {
    near,    // obstacles that the nodes can meet where they are
    distant  // and those that a released node can get to
};

// Finds the near obstacles, the panels that posts and top edges indent, and the predicted motion of the unit relative to each
// obstacle.
ContactPass prepare_pass(const Scene& scene, std::size_t unit, const State& from, Reach reach, Trial& trial);

// Returns whether any block of the group can push, return to its free length, or meet anything.
bool find_group_candidates(const ContactPass& pass, std::size_t group, ContactMemory& memory);

// Sets `reachable` and `indentations` of the block.
void find_block_candidates(const ContactPass& pass, const ContactMemory& memory, ContactBlock& block);

}  // namespace birm3d
