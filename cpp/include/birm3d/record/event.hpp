// The outcome of a run, found step by step. It depends neither on the duration nor on the histories that are kept.
#pragma once

#include <cstdint>
#include <limits>

#include "birm3d/scene/scene.hpp"

namespace birm3d {

enum class Verdict {
    undecided,    // the run ended before
    stopped,      // contained: the motion into the barrier ended, the vehicle rebounds or rests
    redirected,   // contained: it goes on along the barrier
    passed,       // past the barrier's line or its end
    overridden,   // the same, with the barrier's top under the rigid body
    rolled_over,  // contained or undecided, and an up axis was beyond the horizontal
};

// How it came to that.
enum class Manner {
    no_barrier,
    moving,           // undecided
    rests_untouched,  // before the barrier
    rests,            // at the barrier
    rebounds,
    leaves,         // along the barrier
    slides_to_end,  // of the barrier, and goes on
    slides_on,      // along a straight barrier, at rest sideways
    between,        // two elements
    beside,         // the barrier's end
    rests_beyond,
    over,  // the top
};

struct Event {
    // Unit vector across the barrier's line, away from the traffic, and where along it the line is (m).
    Vec3 towards = Vec3::UnitX();
    double line = 0.0;

    bool upright = true;           // at the start: else rolling over means nothing
    double least_upright = 1.0;    // cosine between an up axis and the vertical, least of all units and steps
    bool over_top = false;         // was the mass centre past the line with an element under the rigid body?
    bool crossed = false;          // was it past the line?
    Vec3 crossing = Vec3::Zero();  // where it was then, from the base of the scene (m)

    bool touching = false;  // the barrier, now
    // The last loss of contact: when (s), and the velocity of unit 0 then, world (m/s).
    double released_at = 0.0;
    Vec3 released_velocity = Vec3::Zero();

    // Since when all that moves has had no more kinetic energy than that of a vehicle at rest (s).
    double slow_since = std::numeric_limits<double>::infinity();

    bool left = false;                 // for good?
    bool separated = false;            // and had touched: `released_at` and `released_velocity` are final
    double deflection = 0.0;           // greatest of all trusses when it had left, less their springback (m)
    std::uint64_t later_contacts = 0;  // contacts that began after it had left

    Verdict verdict = Verdict::undecided;  // before rolling over is looked at
    Manner manner = Manner::no_barrier;

    bool decided() const { return verdict != Verdict::undecided; }
    bool rolled_over() const { return upright && least_upright < 0.0; }
    Verdict outcome() const;
};

// Contact of an accepted step.
struct StepContact {
    double begin = 0.0;            // when the step began (s)
    double released = 0.0;         // when its loads end, after that (s)
    bool held_by_barrier = false;  // did the barrier hold the rigid body?
};

Event begin_event(const Scene& scene, const State& start);

// After each accepted step.
void follow_event(const Scene& scene, const State& state, const StepContact& contact, Event& event);

// Is the outcome known, with nothing still to be seen of roll, pitch and what slides? Then the event has its verdict.
bool is_decided(const Scene& scene, const State& state, Event& event);

// Of a run that ends undecided at the longest event: a vehicle that still slides along the barrier is redirected.
void judge_at_longest(const Scene& scene, const State& state, Event& event);

// Greatest deflection of all trusses of all units (m): now, less what covers spring back by without force, and
// during the run.
struct Deflections {
    double now, left, peak;
};
Deflections greatest_deflections(const Vehicle& vehicle, const State& state);

}  // namespace birm3d
