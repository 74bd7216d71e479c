// How far rigid contacts let their bodies move in the drift.
#pragma once

#include <span>
#include <vector>

#include "birm3d/state/state.hpp"
#include "kernels/impulse.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Sets the separation velocities that contacts have to reach in the drift of `dt`. A joint closes its gap.
// A point comes to its surface and no further. One that is inside gets no deeper, but nothing pushes it out: that would
// make kinetic energy. A point of a turning body moves on an arc: it starts away from the surface, so that the arc ends on it.
void set_drift_targets(double dt, std::span<const ContactBody> bodies, const State& state,
                       std::vector<RigidContact>& contacts);

}  // namespace birm3d
