// Crushing and separation of one block of shell nodes (paper 5.3.1, 5.3.2) and the forces of their trusses.
//
// A node at a surface is held on it: pushed back along the normal when the surface has moved in
// (U1 = U + n * penetration), brought along when the surface moves out while the truss still presses.
// The displacement follows the mean of the normal's old and new direction in body axes, so that a path is
// followed to second order while the body turns. From B = node - anchor:
//   deflection d = B_0 - |B|,  truss force F(d) by the law of Fig. 3,  b = B/|B|
//   force on the vehicle:  projected   F * (-b . n) * n      (default)
//                          along_truss F * (-b)              (the paper's rule)
//
// Deviations from the paper: its Eq. 14 (left side P2) as printed moves away from the plane; the push-back
// is p - gap*n. The force is projected on the normal, because the node is free to slide: along the truss it
// would do work on the vehicle that the truss never received. The 5-mm window epsilon is not needed: a node
// is released at the instant at which its truss reaches zero force.
#pragma once

#include "birm3d/model/settings.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/contacts.hpp"
#include "birm3d/state/truss_state.hpp"

namespace birm3d {

// Takes block `b` from `before` to `now`; fills in `contact` and returns the sums (body axes).
SkinForces crush(const RigidBody& body, const TrussMesh& mesh, ContactModel model, std::size_t b,
                 const TrussBlockState& before, TrussBlockState& now, BlockContact& contact);

}  // namespace birm3d
