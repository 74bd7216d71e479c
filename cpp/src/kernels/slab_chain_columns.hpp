// Newton's steps of slab_chain_newton.cpp slab by slab, in plain loops over columns: all of it but what goes from slab to
// slab along the chain.
#pragma once

#include <cstddef>

#include "kernels/slab_chain.hpp"

namespace birm3d {

// Slabs [first, end) of a block.
struct SlabRange {
    SlabBlock& block;
    std::size_t first, end;
};

// Frictions by the law at the motions at hand, rounded off by `soft`. By how much they differ from those used, as a share
// of the limits.
double settle_laws(const SlabRange& slabs, double soft);

// The law at the motions at hand as dual, and none used so far.
void start_from_laws(const SlabRange& slabs, double soft);

// Mobility, and Newton's way without the pins. `rubs`: with friction?
void find_ways(const SlabRange& slabs, bool rubs);

// How fast the places of the pins get when they are pushed, and how fast they are after the way.
void find_responses(const SlabRange& slabs);

// Adds what the pulls of the pins make of the way.
void add_pulls(const SlabRange& slabs);

// `sum`, and the convex function after a share of the way.
double add_value(const SlabRange& slabs, double soft, double share, double sum);

// The motions after a share of the way; take_step() has the frictions follow.
void go_on(const SlabRange& slabs, double share);
void take_step(const SlabRange& slabs, double share);

// The motions without friction and pins.
void back_to_start(const SlabRange& slabs);

// How far the places of the pins move in a drift (m), and how fast they are now.
void find_drifts(const SlabRange& slabs, double drift);

}  // namespace birm3d
