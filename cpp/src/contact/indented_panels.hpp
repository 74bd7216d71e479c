// Which panels posts and top edges indent: see kernels/indentation.hpp.
#pragma once

#include "contact/contact_pass.hpp"

namespace birm3d {

// Sets the indentations of the pass. `list`: their memory; `now`: the part that the state keeps.
void find_indentations(ContactPass& pass, std::vector<IndentedPanel>& list, std::vector<IndentedPanels>& now);

}  // namespace birm3d
