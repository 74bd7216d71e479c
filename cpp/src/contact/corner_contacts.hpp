// Nodes in contact with two or three surfaces at once: see corner.hpp.
#pragma once

#include "contact/contact_pass.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

// Moves such nodes onto all their surfaces, and lists them in `corners`.
void resolve_corner_contacts(const ContactPass& pass, ContactBlock& block);

// Moves the corner's node from the start of the step onto all of its faces.
void resolve_known_corner(const ContactPass& pass, Corner corner, ContactBlock& block);

// Takes the truss forces of these nodes out of `contact`, and adds them to the obstacles by the weights of the faces.
void distribute_corner_forces(const ContactPass& pass, ContactBlock& block, ContactSums& sums);

}  // namespace birm3d
