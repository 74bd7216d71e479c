// Which nodes follow the indentations of posts and top edges: see kernels/indentation.hpp.
#pragma once

#include "contact/contact_pass.hpp"

namespace birm3d {

// Lower bound of the gaps of the nodes within a box to an indentation (m); infinite where it can not reach them.
// `panel_bits`: panels of the nodes. A block that pushes stays at its indentation until it is released.
// `hangs`: does any of the nodes follow a top edge?
double gap_to_indentation(const IndentedPanel& indented, std::uint8_t panel_bits, const Box& box,
                          bool touching, bool hangs);

// Sets the block's indentations, the nearest first, and adds what makes them to its reachable obstacles.
void find_block_indentations(const ContactPass& pass, const std::vector<std::size_t>& of_group,
                             ContactBlock& block);

// Are all nodes on one panel that the obstacle indents? `panel_bits`: panels of the nodes.
bool only_indented(const ContactPass& pass, std::uint8_t panel_bits, std::size_t k);

// Nodes of a panel that a post indents follow the indentation instead of meeting the post: their gaps become infinite.
void omit_indented(const ContactPass& pass, std::size_t block, std::size_t k, NearestOfBlock& found);

// Moves the nodes that follow an indentation.
void follow_indentations(const ContactPass& pass, ContactBlock& block);

}  // namespace birm3d
