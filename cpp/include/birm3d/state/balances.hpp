// The balances of energy and momentum of a run: the greatest departures so far, when and where.
#pragma once

#include <array>
#include <cstddef>

#include "birm3d/base/types.hpp"

namespace birm3d {

struct Balances {
    // Dissipated energies: none of them may ever decrease.
    enum Term : std::size_t {
        crushed,
        barrier_friction,
        tire_friction,
        ground_friction,
        impacts,
        segment_friction,
        dampers,
        sliding,
        yielding,
        terms
    };

    // The greatest so far; time 0 where there is none (J or N s).
    struct Departure {
        double size = 0.0;
        double time = 0.0;          // at the end of the step (s)
        Vec3 place = Vec3::Zero();  // mass centre of the first unit then, world (m)
    };

    bool begun = false;
    double kinetic = 0.0;  // at the start (J)
    double total = 0.0;    // sum of all energy terms at the start (J)
    double at_disposal =
        0.0;             // greatest so far of the initial kinetic energy plus the work of the weight (J)
    Departure energy;    // of the sum of all terms from `total` (J)
    Departure momentum;  // of a unit's momentum change in a step from the impulses on it (N s)
    double largest_momentum = 0.0;        // of a unit, or an impulse in a step: the scale of `momentum` (N s)
    std::array<double, terms> highest{};  // greatest value of each dissipated energy so far (J)
    std::array<Departure, terms> falls;   // decrease of each below that value (J)
};

}  // namespace birm3d
