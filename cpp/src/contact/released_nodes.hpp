// Nodes that a surface releases. The truss of such a node drives it off the surface, outwards along itself, until it has
// its residual length or another surface stops it. On that way nothing outside does work: what the truss loses is lost.
#pragma once

#include "contact/contact_pass.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

// Nodes that an obstacle has drawn out beyond the free length of their trusses return to it once their way is free.
void snap_back(const ContactPass& pass, ContactBlock& block);

// Can the obstacle stop the node itself? A node of a panel that it indents follows the indentation instead.
bool is_solid_to(const ContactPass& pass, std::size_t block, std::size_t lane, std::size_t k);

// Can nodes of the crushed block have been released? `ceased`: has any ceased to push?
bool may_release(const ContactPass& pass, const ContactBlock& block, bool ceased);

// Finds the released nodes that another surface stops. `plane` releases them or, where it is null, the block's faces.
// Nodes that leave an indentation at once stop where they stand. Returns whether there are any of either.
bool find_stopped(const ContactPass& pass, const FlatContact* plane, ContactBlock& block,
                  DistantObstacles& distant);

// Places the stopped nodes and adds what they meet there to what the block sees.
void stop_nodes(const ContactPass& pass, ContactBlock& block, ContactSums& sums);

}  // namespace birm3d
