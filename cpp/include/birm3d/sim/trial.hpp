// The step that is being tried: what half_kick, barrier_forces and try_step hand to each other.
#pragma once

#include <limits>
#include <vector>

#include "birm3d/sim/scene.hpp"
#include "birm3d/state/state.hpp"

namespace birm3d {

// What rigid contacts did to one unit.
struct ContactImpulses {
    explicit ContactImpulses(std::size_t wheels) : tire(wheels, 0.0) {}

    Column tire;                        // (wheels) normal impulse (N s)
    Vec3 tire_friction = Vec3::Zero();  // of all wheels, world axes (N s)
    Vec3 barrier = Vec3::Zero();        // of closed trusses, world axes (N s)
    double barrier_normal = 0.0;        // its part along the normals (N s)
    std::size_t member_contacts = 0;    // closed trusses that carried load
};

// A rigid impact at one end of a step: an instant of its own, not spread over the step.
struct Impact {
    bool happened = false;
    std::vector<BodyState> bodies;          // (units) after an impact at the start, before one at the end
    Energies energies;                      // the same
    std::vector<ContactImpulses> impulses;  // (units)
};

// What the scheme adds to half kicks by the trapezoid rule (see step.hpp), N s and N m s.
struct ThirdOrder {
    Wrench lead;        // lent to the drift, taken back after it
    Wrench correction;  // of the whole step
    double normal_correction = 0.0;
};

// The step that was tried, beside the state it started from.
struct Trial {
    explicit Trial(const Vehicle& vehicle);

    double dt = 0.0;
    State state;                                   // at t + dt; trusses only where active
    std::vector<std::vector<std::size_t>> active;  // (units) blocks near the barrier
    std::vector<ContactImpulses> impulses;         // (units) of lasting contacts, even over the step
    Impact at_start, at_end;
    std::vector<ThirdOrder> third_order;  // (units)
    double error = 0.0;                   // estimated velocity error of this step (m/s)
    double critical_step;                 // sqrt(3)/omega of the trusses in contact (s)
    double impact_after;                  // a rigid impact begins this long after t (s)

    bool body_held() const;  // did the rigid body meet the barrier?
};

struct StepOptions {
    bool locate_impacts = false;  // report a rigid impact within the step instead of letting it happen early
    bool hold_members = true;     // hold the rigid body where a truss is closed
};

}  // namespace birm3d
