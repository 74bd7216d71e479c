// The face that stopped a released node. In an inner corner, as of a Jersey barrier, the nearest face of such a node can be
// the one that has released it: one face drives the node, and its truss presses it against the other.
#pragma once

#include "contact/contact_pass.hpp"

namespace birm3d {

// Sets `stopped_by` and `stays`. `along`: direction of the node's path.
void find_stopping_face(const ContactPass& pass, const ContactBlock& block, const Vec3& along,
                        StoppedNode& node);

// Puts the stopped nodes onto the faces that stopped them, where their nearest face would release them again. A node
// that has been on that face since the start of the step is moved onto both.
void stand_on_stopping_faces(const ContactPass& pass, ContactBlock& block);

}  // namespace birm3d
