// The accounts of each step that is accepted, checked at once: a few sums, no pass over histories.
#pragma once

#include "birm3d/contact/trial.hpp"

namespace birm3d {

// `state`: before the step that was tried is accepted.
void check_ledger(const Scene& scene, const State& state, const Trial& trial, Ledger& ledger);

}  // namespace birm3d
