// A node that two or three surfaces hold at once. It stands on all of them, and the force of its truss is shared out so
// that its work is the work on the truss, whichever way the surfaces come:
//   place   u = sum of a_j h_j,             q_k . u = -g_k          for each face k
//   force   F sum of lambda_k p_k n_k,      sum of lambda_k q_k . h_j = b . h_j  for each face j that the truss pushes on
// with b the unit vector from the node to its anchor, g the gaps, q their gradients by the node's place, -p n those by
// the obstacle's place and h the directions in which the node is displaced (q = p n = h = n at a face; at an indentation, which widens as the post goes
// deeper, they differ, see kernels/indentation.hpp). For any motion of the faces
//   F sum of lambda_k (-dg_k) = F b . du.
// A truss pulls on no face: lambda >= 0. Where a face drives the node and the truss does not push on it, the node moves
// freely there, and no work is done.
#pragma once

#include <array>
#include <cstddef>

#include "birm3d/base/types.hpp"

namespace birm3d {

struct CornerFace {
    std::size_t seen = 0;           // place of the obstacle in ContactBlock::seen
    double gap = 0.0;               // of the node where it was (m)
    Vec3 normal = Vec3::UnitX();    // of the surface there
    Vec3 gradient = Vec3::UnitX();  // q: of the gap, by the node's place
    double per_force = 1.0;         // p: size of the gap's gradient by the obstacle's place
    Vec3 way = Vec3::UnitX();       // h
    Vec3 place = Vec3::Zero();      // where the force acts (m), and the torque of a unit of normal force (m)
    Vec3 torque = Vec3::Zero();
    bool indented = false;  // is it an indentation, which says these two itself?
    double share = 0.0;     // lambda
};

struct Corner {
    static constexpr std::size_t most = 3;

    std::size_t lane = 0;
    std::size_t count = 0;
    std::array<CornerFace, most> face;

    // False where the face is nearly parallel to the known ones: such faces make no corner.
    bool add(const CornerFace& further);

    // Onto all faces; and what of that way leads along those that have a share.
    Vec3 way() const { return way_onto((1U << count) - 1U); }
    Vec3 pushed_way() const { return way_onto(pushing()); }

    // Sets the shares of a truss with the direction b. Returns on how many faces it pushes.
    std::size_t share_out(const Vec3& b);

    // Faces on which the truss does not push let the node go, but those that drive it in.
    void release();

  private:
    unsigned pushing() const;
    Vec3 way_onto(unsigned of) const;
    bool try_shares(unsigned of, const Vec3& b);
};

}  // namespace birm3d
