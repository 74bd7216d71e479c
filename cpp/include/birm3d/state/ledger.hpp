// How well a run keeps its own accounts, from step to step: the greatest departures so far, when and where.
#pragma once

#include <array>
#include <cstddef>

#include "birm3d/base/types.hpp"

namespace birm3d {

struct Ledger {
    // What dissipation has taken does not come back.
    enum Term : std::size_t {
        crushed,
        barrier_friction,
        tire_friction,
        ground_friction,
        impacts,
        segment_friction,
        terms
    };

    // The greatest so far; time 0 where there is none (J or N s).
    struct Departure {
        double size = 0.0;
        double time = 0.0;          // at the end of the step (s)
        Vec3 place = Vec3::Zero();  // mass centre of the first unit then, world (m)
    };

    bool begun = false;
    double kinetic = 0.0;           // at the start (J)
    double total = 0.0;             // of all terms, at the start (J)
    double at_disposal = 0.0;       // greatest so far: kinetic at the start and what the weight has done (J)
    Departure energy;               // of the sum of all terms from that at the start (J)
    Departure momentum;             // of a unit's change in a step from the sum of all impulses on it (N s)
    double largest_momentum = 0.0;  // of a unit, or an impulse in a step (N s)
    std::array<double, terms> highest{};  // of each term so far (J)
    std::array<Departure, terms> falls;   // of each term from there (J)
};

}  // namespace birm3d
