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
    double gap = 0.0;                 // of the node before it is moved (m)
    Vec3 normal = Vec3::UnitX();      // of the surface there
    Vec3 gradient = Vec3::UnitX();    // q: of the gap, by the node's place
    double per_force = 1.0;           // p: size of the gap's gradient by the obstacle's place
    Vec3 direction = Vec3::UnitX();   // h
    Vec3 place = Vec3::Zero();  // where the force acts (m), and the torque of a unit of normal force (m)
    Vec3 torque = Vec3::Zero();
    bool indented = false;  // is it an indentation? Then `place` and `torque` are given
    double weight = 0.0;    // lambda
};

struct Corner {
    static constexpr std::size_t most = 3;

    std::size_t node_index = 0;
    std::size_t count = 0;
    std::array<CornerFace, most> face;
    // Work that is lost as a face drives the node: half the drop of the truss's force times the step's compression (J).
    double lost_work = 0.0;

    // False where the face is nearly parallel to the known ones: such faces make no corner.
    bool add(const CornerFace& further);

    // Displacement onto all faces; and onto those with a weight above zero only.
    Vec3 displacement() const { return displacement_onto((1U << count) - 1U); }
    Vec3 pushed_displacement() const { return displacement_onto(pushing()); }

    // Sets the weights for a truss with the direction b. Returns on how many faces it pushes.
    std::size_t distribute(const Vec3& b);

    // Removes faces on which the truss does not push, unless the node is inside them once it is moved onto the others.
    void release();

  private:
    unsigned pushing() const;
    Vec3 displacement_onto(unsigned subset) const;
    bool try_weights(unsigned subset, const Vec3& b);
};

}  // namespace birm3d
