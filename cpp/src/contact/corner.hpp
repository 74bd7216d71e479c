// A node in contact with two or three surfaces at once. It stands on all of them. The force of its truss is
// distributed over the surfaces. For any motion of the surfaces, their work equals the work on the truss.
// For each face k:
//   g_k  gap of the node
//   q_k  gradient of the gap by the node's place; -p_k n_k: its gradient by the obstacle's place
//   h_k  direction in which the face displaces the node
// and b is the unit vector from the node to its anchor. At a face q = p n = h = n. At an indentation they differ,
// because it widens as the post goes deeper (kernels/indentation.hpp). Displacement u of the node and force on it:
//   u = sum of a_j h_j,             q_k . u = -g_k                for each face k
//   F sum of lambda_k p_k n_k,      sum of lambda_k q_k . h_j = b . h_j  for each face j that the truss pushes on
// Then for any motion of the faces
//   F sum of lambda_k (-dg_k) = F b . du.
// A truss pulls on no face: lambda >= 0. A face may drive the node although the truss does not push on that face. Then
// the node moves freely along it, and no work is done.
#pragma once

#include <array>
#include <cstddef>

#include "birm3d/base/types.hpp"

namespace birm3d {

struct CornerFace {
    std::size_t reachable_index = 0;  // index of the obstacle in ContactBlock::reachable
    double gap = 0.0;                 // signed distance of the node to the face before the node is moved (m)
    Vec3 normal = Vec3::UnitX();      // n: unit normal of the surface at the node, outward
    Vec3 gradient = Vec3::UnitX();    // q: change of the gap for each metre that the node moves
    // p: change of the gap for each metre that the obstacle moves along n; 1 at a face. The normal force on the obstacle
    // is p times `weight` times the force of the truss.
    double per_force = 1.0;
    Vec3 direction = Vec3::UnitX();  // h: unit direction in which the face displaces the node
    // Of an indentation only, as its force acts on the post and not at the node, body axes: where it acts (m), and the
    // torque of a normal force of 1 N about the mass centre (N m).
    Vec3 place = Vec3::Zero();
    Vec3 torque = Vec3::Zero();
    bool indented = false;  // is it an indentation?
    double weight = 0.0;    // lambda: fraction of the truss's force that the face carries, see above
};

struct Corner {
    static constexpr std::size_t most = 3;

    std::size_t node_index = 0;         // in its block
    std::size_t count = 0;              // of the faces
    std::array<CornerFace, most> face;  // the first `count` are in use
    // Work that is lost as a face drives the node: half the drop of the truss's force times the step's compression (J).
    double lost_work = 0.0;

    // False where the face is nearly parallel to the known ones: such faces make no corner.
    bool add(const CornerFace& further);

    // Displacement of the node onto all faces; and onto those with a weight above zero only (m).
    Vec3 displacement() const { return displacement_onto((1U << count) - 1U); }
    Vec3 pushed_displacement() const { return displacement_onto(pushing()); }

    // Sets the weights for a truss with the direction b, from the node to its anchor. Returns on how many faces the truss
    // pushes; 0 if no weights are found.
    std::size_t distribute(const Vec3& b);

    // Removes faces on which the truss does not push, unless the node is inside them once it is moved onto the others.
    void release();

  private:
    // A subset of the faces is a number whose bit k is set for face k.
    unsigned pushing() const;  // subset of those with a weight above zero
    Vec3 displacement_onto(unsigned subset) const;
    bool try_weights(unsigned subset, const Vec3& b);
};

}  // namespace birm3d
