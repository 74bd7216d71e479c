// Nodes in contact with two or three surfaces at once: see corner.hpp.
#pragma once

#include "contact/contact_pass.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

// Moves such nodes onto all their surfaces, and lists them in `corners`.
void resolve_corner_contacts(const ContactPass& pass, ContactBlock& block);

// Moves the corner's node from the start of the step onto all of its faces.
void resolve_known_corner(const ContactPass& pass, Corner corner, ContactBlock& block);

// Moves the forces of these nodes from `contact` to the obstacles, to each its fraction.
void distribute_corner_forces(const ContactPass& pass, ContactBlock& block, ContactSums& sums);

}  // namespace birm3d
