// The parts of slab_chain_newton.cpp that are independent for each slab, in plain loops over columns.
#pragma once

#include <cstddef>

#include "kernels/slab_chain.hpp"

namespace birm3d {

// Slabs [first, end) of a block.
struct SlabRange {
    SlabBlock& block;
    std::size_t first, end;
};

// Sets the frictions by the law at the present motions, regularised by `soft`. Returns the greatest difference from
// the frictions that were used, as a fraction of the limits.
double settle_laws(const SlabRange& slabs, double soft);

// Starts with the law at the present motions as dual and as friction.
void start_from_laws(const SlabRange& slabs, double soft);

// Finds the mobility, and Newton's step without the pins.
void find_newton_steps(const SlabRange& slabs, bool with_friction);

// Finds the velocities of the pins' places for unit impulses, and after Newton's step.
void find_responses(const SlabRange& slabs);

// Adds the effect of the pins' impulses to Newton's step.
void add_pulls(const SlabRange& slabs);

// Returns `sum` plus the convex function after a fraction of Newton's step.
double add_value(const SlabRange& slabs, double soft, double fraction, double sum);

// Moves by a fraction of Newton's step; take_step() updates the frictions as well.
void go_on(const SlabRange& slabs, double fraction);
void take_step(const SlabRange& slabs, double fraction);

// The motions without friction and pins.
void back_to_start(const SlabRange& slabs);

// How far the places of the pins move in a drift (m), and how fast they are now.
void find_drifts(const SlabRange& slabs, double drift);

}  // namespace birm3d
