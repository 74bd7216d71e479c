// The outcome of a run, found step by step, whatever histories are kept.
#pragma once

#include <cstdint>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/scene/scene.hpp"

namespace birm3d {

enum class Verdict {
    undecided,   // the run ended before the outcome was known
    stopped,     // the barrier contained the vehicle, which rebounds from it or rests
    redirected,  // the barrier contained the vehicle, which goes on along it
    passed,      // the vehicle got past the barrier's line or its end
    overridden,  // it got past the line over the barrier's top, or rolled over and is behind the element that it crossed
    rolled_over,  // an up axis of a unit pointed below the horizontal, and the vehicle is neither `passed` nor `overridden`
};

// How the vehicle came to its verdict.
enum class Manner {
    no_barrier,       // the scene has no barrier
    moving,           // the vehicle still moves, and its outcome is not known
    rests_untouched,  // it rests before the barrier, which it never touched
    rests,            // it rests at the barrier
    rebounds,         // it moves back from the barrier
    leaves,           // it leaves the barrier before its end
    slides_to_end,    // it slides to the barrier's end and goes on
    slides_on,        // it slides along a straight barrier without any other motion
    between,          // it passed between two elements
    beside,           // it passed beside the barrier's end
    rests_beyond,     // it rests past the line
    over,             // it went over the top
    slow,  // it is still at the barrier as a long run ends, slower than a tenth of its approach speed
};

struct Event {
    Vec3 towards = Vec3::UnitX();  // unit vector across the barrier's line, away from the traffic, world axes
    double line = 0.0;             // coordinate of the line along `towards`, from the base of the scene (m)

    bool upright = true;  // did all units stand upright at the start? Otherwise rolling over has no meaning
    double least_upright = 1.0;  // least cosine between an up axis and the vertical, of all units and steps
    // Was unit 0's mass centre ever past the line with an element under its rigid body?
    bool over_top = false;
    bool crossed = false;          // was unit 0's mass centre ever past the line?
    Vec3 crossing = Vec3::Zero();  // unit 0's mass centre as it first was past the line, world axes (m)
    // Has it rolled over, and is that mass centre behind the far side of the element that it crossed?
    bool behind_element = false;

    bool touching = false;                  // does the vehicle touch the barrier now?
    double released_at = 0.0;               // time at which it last lost contact with the barrier (s)
    Vec3 released_velocity = Vec3::Zero();  // velocity of unit 0's mass centre at that time, world axes (m/s)

    // Time since which the kinetic energy has been below that of a vehicle that creeps, see record/rest.cpp (s).
    double creeping_since = infinity;

    // Time since which the vehicle has slid along the barrier with no other motion (s), and its speed then (m/s).
    double slides_since = infinity;
    double slides_from_speed = 0.0;

    bool left = false;        // has the vehicle left the barrier for good?
    bool clear = false;       // and been far from it since, see tolerance::clear_of_barrier?
    bool separated = false;   // has it touched the barrier and left? Then the values of release are final
    double deflection = 0.0;  // greatest deflection of any truss as it had left, less its springback (m)
    std::uint64_t later_contacts = 0;  // number of contacts that began after it had left

    Verdict verdict = Verdict::undecided;  // the verdict without regard to rolling over, see outcome()
    Manner manner = Manner::no_barrier;

    // Has the barrier turned the vehicle back, so that it clearly moved away from the line as it lost contact?
    bool turned_back() const {
        return released_velocity.dot(towards) < -tolerance::nearly_along * released_velocity.norm();
    }
    bool is_past() const { return verdict == Verdict::passed || verdict == Verdict::overridden; }
    bool decided() const { return verdict != Verdict::undecided; }
    bool rolled_over() const { return upright && least_upright < 0.0; }
    Verdict outcome() const;
};

// What an accepted step says about contact.
struct StepContact {
    double begin = 0.0;            // time at which the step began (s)
    double released = 0.0;         // time after `begin` at which the contact loads of the step end (s)
    bool held_by_barrier = false;  // did the barrier hold the rigid body in this step?
};

// The event of a run that starts from `start`.
Event begin_event(const Scene& scene, const State& start);

// Updates the event after each accepted step. `state`: at the end of the step.
void follow_event(const Scene& scene, const State& state, const StepContact& contact, Event& event);

// Is the outcome known, with nothing still to be seen of roll, pitch and what slides? Then the event has its verdict.
bool is_decided(const Scene& scene, const State& state, Event& event);

// Does an undecided vehicle move free of the barrier? It may still roll past it or come to rest.
bool rolls_on(const State& state, const Event& event);

// Gives an undecided run its verdict, if it ends at tolerance::longest_event or later. A vehicle that still slides along the
// barrier is redirected, one that is slow is stopped.
void judge_at_longest(const Scene& scene, const State& state, Event& event);

// Greatest deflections of the trusses of the skin of all units, without second trusses and treads (m).
struct Deflections {
    double now;   // the greatest deflection of the state
    double left;  // the same, less what covers spring back by without force
    double peak;  // the greatest deflection since the run began
};
Deflections greatest_deflections(const Vehicle& vehicle, const State& state);

}  // namespace birm3d
