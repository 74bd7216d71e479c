// What each node of a block meets: the nearest surface, its normal now, and its normal at the start of the step.
#pragma once

#include "contact/contact_pass.hpp"

namespace birm3d {

// Sets `faces`, the normals of `contact`, `nearest` and `corners` of the block, indentations and corners included.
void find_nearest_surface(const ContactPass& pass, ContactBlock& block);

}  // namespace birm3d
