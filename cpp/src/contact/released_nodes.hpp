// Nodes that a surface releases. The truss of such a node extends and pushes it off the surface. It stops at its
// residual length, or where another surface stops the node. Nothing receives the work of this motion: the energy that
// the truss releases is dissipated.
#pragma once

#include "contact/contact_pass.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

// Returns nodes that an obstacle held beyond the free length of their trusses, once their path is free.
void snap_back(const ContactPass& pass, ContactBlock& block);

// Can the obstacle stop the node itself? A node of a panel that it indents follows the indentation instead.
bool is_solid_to(const ContactPass& pass, std::size_t block, std::size_t node_index, std::size_t k);

// Can nodes of the crushed block have been released? `ceased`: has any node stopped pushing?
bool may_release(const ContactPass& pass, const ContactBlock& block, bool ceased);

// Finds two kinds of nodes: those that a surface has released and another one stops, and all that an indentation has released.
// `plane` is that surface; if it is null, the block's faces are. Returns whether there are any.
bool find_stopped(const ContactPass& pass, const FlatContact* plane, ContactBlock& block,
                  DistantObstacles& distant);

// Places the stopped nodes and adds the obstacles that they meet there to those that the block reaches.
void stop_nodes(const ContactPass& pass, ContactBlock& block, ContactSums& sums);

}  // namespace birm3d
