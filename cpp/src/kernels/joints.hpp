// Joints as rows of the impulse solver, for any two bodies.
//
// Held directions are the world's x, y, z at the joint's place, halfway between its two places so that the pair
// of impulses keeps the angular momentum whatever gap there is; of a welded joint also turns about x, y, z. The stops of
// a fifth wheel are two rows about the Cardan axis s_leading x t_trailing, along which the rate of the relative
// roll is the difference of the angular velocities: sin(roll) = -s_leading . t_trailing.
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

// Of the trailing body relative to the leading one.
JointAngles joint_angles(const Quat& leading, const Quat& trailing);

}  // namespace birm3d
