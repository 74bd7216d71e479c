// Which panels posts indent, and which nodes follow: see kernels/indentation.hpp.
#pragma once

#include "contact/contact_pass.hpp"

namespace birm3d {

// Sets what the pass knows of indentations. `list`: their memory; `now`: what the state keeps of them.
void find_indentations(ContactPass& pass, std::vector<IndentedPanel>& list, std::vector<IndentedPanels>& now);

// How near nodes of some panels, bit by bit, within a box can be to an indentation (m). Infinite where it can not reach
// them. A block that pushes stays at its indentation until it is released, though the step may have drawn it off.
double gap_to_indentation(const IndentedPanel& indented, std::uint8_t of, const Box& box, bool touching);

// Sets the block's indentations, the nearest first, and adds their posts to what it sees.
void find_block_indentations(const ContactPass& pass, const std::vector<std::size_t>& of_group,
                             ContactBlock& block);

// Does the obstacle indent the one panel that all nodes of some panels, bit by bit, are on?
bool only_indented(const ContactPass& pass, std::uint8_t of, std::size_t k);

// Nodes of a panel that a post indents follow the indentation instead of meeting the post: their gaps become infinite.
void omit_indented(const ContactPass& pass, std::size_t block, std::size_t k, NearestOfBlock& found);

// Nodes that an indentation holds follow it.
void follow_indentations(const ContactPass& pass, ContactBlock& block);

}  // namespace birm3d
