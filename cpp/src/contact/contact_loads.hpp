// The loads of a unit on each obstacle, with friction, and their sums for the step.
#pragma once

#include "contact/contact_pass.hpp"
#include "contact/trial.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

// Adds the friction of a crushed block's nodes on the k-th near obstacle. `places`: where the forces in `contact` act.
void apply_friction(const ContactPass& pass, std::size_t k, const Places& places, const BlockContact& contact,
                    const ContactBlock& block, ContactSums& sums);

// Adds to each obstacle the loads of those nodes of the block that push on it, with friction.
void distribute_loads(const ContactPass& pass, ContactBlock& block, ContactSums& sums);

// Stores the sums as the unit's loads, world axes.
void store_loads(const ContactPass& pass, Trial& trial);

}  // namespace birm3d
