// Joints as rows of the impulse solver, for any two bodies.
//
// A joint has rows for displacements along the world's x, y and z; a welded joint also for rotations about them.
// Displacement rows of a sliding joint follow the leading body's axes. The row along its r axis carries force up to a limit.
// Impulses act halfway between the joint's places on the two bodies. So a pair of impulses keeps the angular momentum, whatever
// the gap between these places. The stops of a fifth wheel are two rows about the Cardan axis s_leading x t_trailing.
// The difference of the angular velocities along it is the rate of the relative roll, sin(roll) = -s_leading . t_trailing.
#pragma once

#include <vector>

#include "birm3d/model/joint.hpp"
#include "birm3d/state/body_state.hpp"
#include "birm3d/state/contacts.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Appends the joint's rows: `index` of the joint. All impulses act on the leading body in the row's direction.
void find_joint_rows(const Joint& joint, std::size_t index, const BodyState& leading,
                     const BodyState& trailing, std::vector<RigidContact>& rows);

// Gap of a bilateral row after the drift: displacement (m) or rotation (rad) of the leading body from the trailing
// one in the row's direction.
double bilateral_gap(const Joint& joint, const RigidContact& row, const BodyState& leading,
                     const BodyState& trailing);

// How far a sliding joint's trailing body has slid forwards along the leading body's r axis (m).
double slip_of(const Joint& joint, const BodyState& leading, const BodyState& trailing);

// Force that a sliding joint holds at that slip (N).
double slide_force(const Joint& joint, double slip);

// Of the trailing body relative to the leading one.
JointAngles joint_angles(const Quat& leading, const Quat& trailing);

}  // namespace birm3d
