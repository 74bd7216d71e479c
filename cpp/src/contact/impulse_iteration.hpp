// Solves for the impulses of rigid contacts and joints with their friction, and kicks the bodies by them.
#pragma once

#include "contact/rigid_contacts.hpp"

namespace birm3d {

// What a kick needs to know beside the state.
struct KickedBy {
    const Column&
        pressed;  // (free-standing segments) impulse on the ground by all forces but rigid contacts (N s)
    std::span<const Twist> at_end;  // (bodies) their motions at that end of the step (see TireMotion)
    std::span<const Twist> from;    // (bodies) their motions before this kick
    double time = 0.0;              // for which the loads of springs and dampers act (s)
    double drift = 0.0;             // length of the drift after which joints are to be closed (s)
    bool is_impact = false;         // without duration: springs and dampers do not act
};

// Solves for the impulses of `memory.kick.contacts` and their friction on top of the bodies' motions, and kicks the bodies.
void kick_by_contacts(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state);

// The same before the drift. Adjusts the targets of joints until their gaps are closed after the drift (Ryckaert,
// Ciccotti and Berendsen, J. Comput. Phys. 23, 1977, p. 327; with velocities that agree after it: Andersen, J.
// Comput. Phys. 52, 1983, p. 24).
void kick_towards_closed_joints(const Scene& scene, const KickedBy& by, KickMemory& memory, State& state);

}  // namespace birm3d
