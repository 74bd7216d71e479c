// Crushing and separation of one block of shell nodes (paper 5.3.1, 5.3.2) and the forces of their trusses.
//
// A node at a surface is held on it. It is pushed back along the normal by its contact depth when the surface has moved in:
// U1 = U + n d_c. It follows a surface that moves out while its truss still pushes. The displacement is along
// the mean of the normals at the start and at the end of the step, in body axes. So paths are followed to second order
// while the body rotates. From B = node - anchor:
//   deflection d = B_0 - |B|,  truss force F(d) by the law of Fig. 3,  b = B/|B|
//   force on the vehicle:  projected   F * (-b . n) * n      (default)
//                          along_truss F * (-b)              (the paper's rule)
// A truss that points away from the surface (b . n > 0) does not push. It extends at once to its residual length.
//
// Both are cases of one rule: with h the direction of the node's displacement, h . n = 1, the force is F * (-b . h) *
// n. Nodes that follow an indentation have their own h and n (indentation.hpp).
//
// Deviations from the paper: its Eq. 14 (left side P2) as printed moves away from the plane; the push-back
// is p - gap*n. The force is projected on the normal, because the node is free to slide: along the truss it
// would do work on the vehicle that the truss never received. The 5-mm window epsilon is not needed: a node
// is released at the instant at which its truss reaches zero force.
#pragma once

#include "base/node_sums.hpp"
#include "birm3d/geometry/half_space.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/contacts.hpp"
#include "birm3d/state/truss_state.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

// The inverse effective mass of a node along n (the denominator of Eq. 1), 1/m + (r x n) . I^-1 (r x n), as a
// quadratic form in its place r, body axes. A node is displaced along n, which does not change r x n. So uncrushed
// places give the same result.
struct InverseMass {
    InverseMass(const RigidBody& body, const Vec3& normal);

    double constant;  // 1/kg
    Mat3 form;        // 1/(kg m^2)
};

// A flat surface that the nodes of a unit push on, at the end and at the start of the step (body axes).
struct FlatContact {
    FlatContact(const RigidBody& body, const HalfSpace& face_, const HalfSpace& face_before);

    HalfSpace face;
    // Displacement of nodes in contact for each unit of gap: along n + m, with m the normal at the start of the step.
    // So paths are followed to second order while the body rotates.
    Vec3 holding;
    InverseMass inverse_mass;
};

// Sums over the blocks of a unit.
struct CrushSums {
    NodeSums nodes;
    double released_work =
        0.0;  // correction of the work on trusses whose nodes were released within the step (J)
    double flat_stiffness = 0.0;  // of flat surfaces, see SkinForces (1/s^2)

    double work() const { return 0.5 * packet_sum(nodes.twice_work) + released_work; }  // on trusses (J)
    double stored() const { return 0.5 * packet_sum(nodes.twice_stored); }              // J
    double stiffness() const { return flat_stiffness + packet_sum(nodes.stiffness); }   // 1/s^2
    double normal_force() const { return packet_sum(nodes.force); }                     // N

    // Subtracts the sums of one block.
    CrushSums& operator-=(const CrushSums& part);
};

// Moves block `b` from `before` to `now`, sets the normal forces of `contact` and adds to the sums. The caller has set
// the normals of `contact`. `factor`: on the loading envelopes, may be null. Returns whether any node stopped
// pushing.
bool crush(const FlatContact& surface, const TrussMesh& mesh, std::size_t b, const BlockColumn* factor,
           const TrussBlockState& before, TrussBlockState& now, BlockContact& contact, CrushSums& sums);
bool crush(const NodeFaces& faces, const RigidBody& body, const TrussMesh& mesh, std::size_t b,
           const BlockColumn* factor, const TrussBlockState& before, TrussBlockState& now,
           BlockContact& contact, CrushSums& sums);

// Force and torque of the blocks that met one plane, and of those that met surfaces of any shape; projected, body
// axes.
Wrench total_wrench(const FlatContact& surface, const CrushSums& sums);
Wrench total_wrench(const CrushSums& sums);

// The force of a block by the paper's rule: each truss pushes along itself (body axes).
Wrench along_trusses(const TrussBlock& truss, const TrussBlockState& now, const BlockContact& contact);

// Sets the factor on the loading envelopes by the rate of deflection (TrussInput). `motion`: of the body relative to
// the surface (body axes). The block has been crushed without the factor before.
void set_rate_factor(double rate_sensitivity, const BlockColumn& force, const Twist& motion,
                     const Places& places, const BlockContact& contact, BlockColumn& factor);

}  // namespace birm3d
