// Friction of tires at the barrier: see kernels/friction_tire.hpp.
#pragma once

#include "contact/contact_pass.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

// Lists the tyre contact nodes of a block that push on the k-th near obstacle.
void note_tire_nodes(const ContactPass& pass, std::size_t k, std::size_t block, const Places& places,
                     const BlockContact& contact, ContactSums& sums);

// Adds the friction of all listed nodes. It is added at the end because the speed of a free wheel follows from all
// its nodes.
void add_tire_friction(const ContactPass& pass, ContactSums& sums);

}  // namespace birm3d
