// Friction impulses of tyres and bottomed-out trusses, at given normal impulses.
#pragma once

#include "contact/impulse_iteration.hpp"

namespace birm3d {

// Motions of the bodies at which contacts slide.
const std::vector<Twist>& sliding_motions(const KickMemory& memory);

// Sums the normal impulses of the tyres by wheel, in memory.iteration.tire (N s). Springs and dampers take no part in an impact.
void sum_tire_impulses(const Scene& scene, const KickedBy& by, KickMemory& memory);

// Finds memory.iteration.held: motions of the bodies with the normal impulses and those of joints, without friction. Springs push
// joined units apart, and the joint resists. Without its impulse, tyres would seem to slide.
void find_held_motions(const Scene& scene, const KickedBy& by, KickMemory& memory);

// Finds the friction of tyres and of bottomed-out trusses, on the vehicle and on moving elements, at the present normal impulses.
// Kicks the units by what has changed since the last time.
void kick_by_friction(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state);

// Is there any friction of tyres or bottomed-out trusses?
bool any_friction(const ContactKick& kicked);

}  // namespace birm3d
