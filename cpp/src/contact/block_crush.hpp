// Crushes one block on what it meets, adds its forces to the sums, and stops the nodes that are released meanwhile.
#pragma once

#include "contact/contact_pass.hpp"

namespace birm3d {

// Returns the sums of the plane if the block can meet nothing but one plane, else null. Parts of the same element may be in
// reach behind that plane.
PlaneSums* only_plane(const ContactPass& pass, const ContactBlock& block, ContactSums& sums);

void crush_on_plane(const ContactPass& pass, PlaneSums& plane, ContactState& state);

// Call find_nearest_surface() for the block first.
void crush_on_surfaces(const ContactPass& pass, ContactState& state);

}  // namespace birm3d
