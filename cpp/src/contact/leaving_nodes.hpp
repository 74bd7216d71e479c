// Nodes that an indentation has released, or that it held when it vanished.
#pragma once

#include "contact/contact_pass.hpp"

namespace birm3d {

// Did a post or a top edge indent any panel that the block has nodes of?
bool was_indented(const ContactPass& pass, const ContactBlock& block);

// Marks with 1 the nodes of the crushed block that an indentation has released, and those that it held when it vanished within
// this step. It vanishes as its post tips across the panel, or as a top edge has passed under the node. Such a node is far from
// the surface or the indentation that it would follow now: further than the motions of the step allow.
void find_leaving(const ContactPass& pass, const ContactBlock& block, BlockColumn& leaves);

// Work in this step on the trusses of nodes that leave (J). By the trapezoid rule the force with which an indentation held a node
// as the step began has acted over half of the obstacle's way. Zero for nodes that no indentation held then.
void find_work_until_leaving(const ContactPass& pass, const ContactBlock& block, BlockColumn& work);

}  // namespace birm3d
