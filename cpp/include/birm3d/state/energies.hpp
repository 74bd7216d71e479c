// The terms of a run's energy balance, and the one list of them: sums, records, checks and bindings go by this.
#pragma once

#include <array>
#include <cstddef>

namespace birm3d {

// All in J. A run starts with `kinetic` alone; all others are zero.
struct Energies {
    double kinetic = 0.0, potential = 0.0, stored = 0.0, crushed = 0.0;
    double barrier_friction = 0.0, tire_friction = 0.0, ground_friction = 0.0;
    double impacts = 0.0, joints = 0.0, barrier_ground_friction = 0.0;
    double springs = 0.0, dampers = 0.0, sliding = 0.0, yielding = 0.0;

    double total() const;
};

struct EnergyTerm {
    const char* name;
    double Energies::* value;
    bool is_loss;  // it may never fall
    const char* meaning;
};

// Those that are no loss rise and fall. `joints` is zero up to the error of the steps.
inline constexpr std::array energy_terms{
    EnergyTerm{"kinetic", &Energies::kinetic, false, "kinetic energy of all bodies"},
    EnergyTerm{"potential", &Energies::potential, false, "of the weight, zero at the start"},
    EnergyTerm{"stored", &Energies::stored, false, "elastic energy in trusses"},
    EnergyTerm{"crushed", &Energies::crushed, true, "plastic work in trusses"},
    EnergyTerm{"barrier_friction", &Energies::barrier_friction, true, "lost to friction on the barrier"},
    EnergyTerm{"tire_friction", &Energies::tire_friction, true, "lost to friction of tyres on the ground"},
    EnergyTerm{"ground_friction", &Energies::ground_friction, true,
               "lost to friction of the skin on the ground"},
    EnergyTerm{"impacts", &Energies::impacts, true, "lost in rigid contacts"},
    EnergyTerm{"joints", &Energies::joints, false, "that joints took: zero but for the error of the steps"},
    EnergyTerm{"barrier_ground_friction", &Energies::barrier_ground_friction, true,
               "lost to friction of free-standing segments on the ground"},
    EnergyTerm{"springs", &Energies::springs, false, "in the springs of wheels, less that at rest"},
    EnergyTerm{"dampers", &Energies::dampers, true, "lost in the dampers of wheels"},
    EnergyTerm{"sliding", &Energies::sliding, true, "lost where a unit slides on another one"},
    EnergyTerm{"yielding", &Energies::yielding, true, "plastic work of posts that yield"},
};

// Index of a term in energy_terms.
constexpr std::size_t index_of(double Energies::* term) {
    std::size_t i = 0;
    while (energy_terms[i].value != term)
        ++i;
    return i;
}

inline double Energies::total() const {
    double sum = 0.0;
    for (const EnergyTerm& term : energy_terms)
        sum += this->*term.value;
    return sum;
}

}  // namespace birm3d
