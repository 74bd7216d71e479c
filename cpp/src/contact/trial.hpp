// The trial step: the data that half_kick, find_contact_forces and try_step pass to each other.
#pragma once

#include <limits>
#include <vector>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/state/state.hpp"
#include "contact/contact_memory.hpp"
#include "kernels/detect_core.hpp"
#include "kernels/impulse.hpp"
#include "kernels/slab_chain.hpp"
#include "kernels/suspension.hpp"
#include "scene/obstacles.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// Impulse of the rigid body of one unit on one obstacle, world axes.
struct ObstacleImpulse {
    std::size_t obstacle = 0;
    Vec3 impulse = Vec3::Zero();  // on the unit (N s)
    Vec3 torque = Vec3::Zero();   // on the obstacle, about its own point (N m s)
};

// Impulses of rigid contacts on one unit.
struct ContactImpulses {
    explicit ContactImpulses(std::size_t wheels) : tire(wheels, 0.0), sprung(wheels, 0.0) {}

    Column tire;                             // (wheels) normal impulse (N s)
    Column sprung;                           // (wheels) part of it that springs and dampers carry (N s)
    Vec3 tire_friction = Vec3::Zero();       // of all wheels, world axes (N s)
    std::vector<ObstacleImpulse> obstacles;  // of bottomed-out trusses
    double barrier_normal = 0.0;             // sum of the normal impulses on the barrier among them (N s)
    std::size_t core_contacts = 0;           // bottomed-out trusses that carried load
    Vec3 joints = Vec3::Zero();              // of all its joints, world axes (N s)
};

// A rigid impact at one end of a step. It has no duration: its impulses are not spread over the step.
struct Impact {
    bool happened = false;
    std::vector<BodyState> bodies;  // (units) after an impact at the start, before one at the end
    // The same of the barrier.
    std::vector<BodyState> moving_elements;
    Energies energies;                      // the same
    std::vector<ContactImpulses> impulses;  // (units)
    std::vector<Wrench> joint_impulses;     // (joints) on the leading unit, about the joint (N s, N m s)
};

// Impulses of rigid contacts and joints at one end of the drift.
struct ContactKick {
    std::vector<RigidContact> contacts;
    std::vector<Wrench> on_ground;  // (units) friction impulses of tyres
    std::vector<Wrench> on_cores;   // (bodies) friction impulses of bottomed-out trusses
    std::vector<Wrench>
        on_base;  // (moving elements) impulses of ground friction on segments, of the plastic moment on posts
    std::vector<Wrench> on_pins;     // (moving elements) of the pins to their neighbours
    std::vector<char> rolls_freely;  // (units) is the friction of its tyres left out? Empty: of no unit
};

// Motions of all bodies in a half kick.
struct KickMotions {
    std::vector<Twist> before, pushed,
        after;                   // before the kick, with the forces, and with the rigid contacts, too
    std::vector<Twist> rolling;  // in the drift: tyres roll or slide by them
    std::vector<Twist> start;    // before the first half kick of the step
    // Those that the friction of an impact acts against; empty: those before it.
    std::vector<Twist> sliding;
};

// Of the rounds in which impulses and friction are found, see impulse_iteration.hpp.
struct ImpulseRounds {
    ImpulseSolver solver;
    std::vector<Twist> held;                // (bodies) motions with the impulses of joints
    std::vector<Column> tire;               // (units) normal impulses by wheel (N s)
    Column last;                            // normal impulses of the round before (N s)
    std::vector<Wrench> on_cores, on_base;  // friction of the round before
};

// Of free-standing segments, see base_reactions.hpp.
struct SegmentMemory {
    std::vector<PinnedSlab> slabs;
    std::vector<SlabPin> pins;
    SlabChain chain;
    Column limits;              // of friction on the ground (N s)
    std::vector<Vec3> motions;  // along the ground and about the vertical
};

// Of posts that yield, see post_tilting.hpp.
struct PostMemory {
    std::vector<Vec3> momenta;             // angular, without the plastic moments (N m s)
    std::vector<Vec3> angular_velocities;  // with them (rad/s)
    std::vector<char> held;                // do they stand still?
};

// Work buffers of half kicks, so that a step allocates nothing. Their values hold within one half kick only, apart from
// KickMotions::start.
struct KickMemory {
    std::vector<RigidContact> contacts;
    std::vector<PlacedShape> placed;
    std::vector<std::size_t> about;
    std::vector<ContactBody> bodies;
    std::vector<std::vector<SuspensionLoad>> sprung;  // (units) loads of the wheels that stand on springs
    ContactKick kick;
    KickMotions motions;
    ImpulseRounds iteration;
    SegmentMemory segments;
    PostMemory posts;
};

// Some of the blocks of a mesh.
class BlockSet {
  public:
    explicit BlockSet(std::size_t blocks) : has_(blocks, char{0}) {}

    bool contains(std::size_t block) const { return has_[block] != 0; }
    void add(std::size_t block) {
        if (contains(block)) return;
        has_[block] = 1;
        blocks_.push_back(block);
    }
    void clear() {
        for (const std::size_t block : blocks_)
            has_[block] = 0;
        blocks_.clear();
    }
    const std::vector<std::size_t>& blocks() const { return blocks_; }

  private:
    std::vector<std::size_t> blocks_;
    std::vector<char> has_;
};

// The step that was tried, beside the state it started from.
struct Trial {
    explicit Trial(const Vehicle& vehicle);

    // Prepares the trial for steps from another state of the same vehicle, in the same memory.
    void restart(const Vehicle& vehicle, const State& state);

    // Prepares a step of `step` seconds from `from`: copies all but the trusses, clears all sums.
    void begin(const State& from, double step);

    // Gives unit u's blocks of trusses of this step to `with` and takes those of the step before in return.
    void exchange_trusses(std::size_t u, TrussState& with);

    double dt = 0.0;
    State state;                            // at t + dt; trusses only where active
    std::vector<BlockSet> active;           // (units) blocks near the barrier
    std::vector<BlockSet> stale;            // (units) blocks that may differ from the state's
    std::vector<ContactImpulses> impulses;  // (units) of lasting contacts, even over the step
    std::vector<Wrench> joint_impulses;     // (joints) the same, on the leading unit, about the joint
    std::vector<Twist> by_contacts;  // (bodies) change of their motions by rigid contacts before the drift
    Column drift_velocity_z;         // (units) vertical velocity in the drift (m/s)
    Impact at_start, at_end;
    std::vector<std::size_t>
        reached;  // obstacles within reach of any block of nodes, listed once for each unit
    ContactMemory skin;
    std::vector<LoadHistory>
        histories;  // working memory of correct_loads(), so that a step allocates nothing
    std::vector<Load> loads;
    KickMemory memory;
    double error = 0.0;    // estimated velocity error of this step (m/s)
    double critical_step;  // sqrt(3)/omega of the trusses in contact (s)
    double impact_after;   // a rigid impact begins this long after t (s)

    // Does a rigid impact begin within the step? Then try_step() returned when it was found, and the trial is
    // incomplete.
    bool impact_within() const { return impact_after < dt && dt > 2.0 * tolerance::shortest_step; }

    bool body_rests() const;  // on tyres or bottomed-out trusses
    bool body_held() const;   // did the rigid body meet the barrier or the ground?
    bool body_held_by_barrier() const;
};

// The two half kicks of a step, before and after the drift.
enum class Stage { before_drift, after_drift };

struct StepOptions {
    bool locate_impacts =
        false;  // report a rigid impact within the step instead of computing it at the start of the step
    bool hold_core = true;  // apply contacts of the rigid body where a truss is bottomed out
};

}  // namespace birm3d
