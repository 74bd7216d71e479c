// Crushes one block on what it meets, adds its forces to the sums, and stops the nodes that are released meanwhile.
#pragma once

#include "contact/contact_pass.hpp"

namespace birm3d {

// The sums of the plane that is all that the block can meet; null where it can meet more.
PlaneSums* only_plane(const ContactPass& pass, const ContactBlock& block, ContactSums& sums);

void crush_on_plane(const ContactPass& pass, PlaneSums& plane, ContactState& state);

// find_nearest_surface() has been called for the block.
void crush_on_surfaces(const ContactPass& pass, ContactState& state);

}  // namespace birm3d
