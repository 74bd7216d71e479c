// The balances of energy and momentum of a run: the greatest departures so far, when and where.
#pragma once

#include <array>

#include "birm3d/base/types.hpp"
#include "birm3d/state/energies.hpp"

namespace birm3d {

struct Balances {
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
    double largest_momentum = 0.0;  // of a unit, or an impulse in a step: the scale of `momentum` (N s)
    // In the order of energy_terms, of losses: the greatest value so far, and the decrease below that (J).
    std::array<double, energy_terms.size()> highest{};
    std::array<Departure, energy_terms.size()> falls;
};

}  // namespace birm3d
