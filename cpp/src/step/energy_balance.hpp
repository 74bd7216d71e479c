// Energy and momentum of each step, and how far their balances are from closing. The check costs a few sums a step.
#pragma once

#include "contact/trial.hpp"

namespace birm3d {

// Energies of the trusses of all units: what they store, and what crush has dissipated.
void sum_truss_energies(State& now);

// Energy that the springs of wheels store; zero where wheels have none.
void sum_spring_energies(const Scene& scene, State& now);

// Kinetic energy of all units and moving elements.
void sum_kinetic_energy(const Scene& scene, State& now);

// Enters the greatest departures from both balances into `balances`. `state`: before the trial is accepted.
void check_balances(const Scene& scene, const State& state, const Trial& trial, Balances& balances);

}  // namespace birm3d
