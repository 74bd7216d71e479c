// Skin that hangs over the top of a wall can sink into the wall with the vehicle. The top edge later releases such a node inside
// the wall: it lags behind the wall's faces. So does skin beside a post whose indentation has vanished: free nodes may be
// inside the post. And so does skin that an upright edge has pushed aside by less than its flank: past the edge's axis it is
// inside the face (TrussBlockState::lagging). A face moves such a node only by as much as the face itself moves. To push it
// out at once would crush its truss by energy that the body never lost.
#pragma once

#include "contact/contact_pass.hpp"

namespace birm3d {

// Gap that a node had as the step began, to a plane that goes with the obstacle (m). `node`: its place then, body axes (m).
// `normal`, `gap`: of the plane at the end of the step, to that place.
double gap_as_step_began(const NearObstacle& near, const Vec3& node, const Vec3& normal, double gap);

// Does a node with that gap lag? Others are on the plane, to rounding and to the chords of their paths.
bool lags_behind(double gap_as_step_began);

// The gap to use in this step. Of a node that lags inside the plane: only the plane's advance within the step.
double without_lag(const NearObstacle& near, const Vec3& node, const Vec3& normal, double gap);

// Takes the lag out of the gaps to the nearest surfaces, and sets ContactBlock::lags. Other nodes stay as they
// are: those that did not lag in the last step, in blocks that did not hang over a top and that no indentation has left.
void keep_lags(const ContactPass& pass, ContactBlock& block);

}  // namespace birm3d
