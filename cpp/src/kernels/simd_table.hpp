// The one table of functions that are compiled for several instruction sets. A row is one instruction set.
//
// Every function is the innermost loop of a kernel over one block: kernels/*_simd.cpp. All rows give the same bits.
//
// Speed of a whole run relative to the baseline, from tests/bench/bench_simd.py (results/simd/simd.csv):
//                                     avx2    avx512f
//   10,000 trusses at a wall          1.87    2.58
//   car at a wall, 25 degrees         1.38    1.51
//   car at a Jersey barrier           1.57    1.88
//   pickup at bollards                1.80    2.21
// These numbers include the plain loops of base/block_loop.hpp, which the compiler clones for the same instruction sets.
// Without the clones, and with avx512f: 2.56, 1.37, 1.53 and 1.80.
#pragma once

#include <vector>

#include "kernels/crush_simd.hpp"
#include "kernels/detect_simd.hpp"
#include "kernels/friction_simd.hpp"
#include "kernels/indentation_simd.hpp"

namespace birm3d {

struct SimdPath {
    const char* instruction_set;
    // kernels/crush: moves the nodes of a block onto a surface and finds the forces of their trusses.
    Press<FlatPress> press_flat;
    Press<CurvedPress> press_curved;
    // kernels/detect: distances of the nodes of a block from a prism.
    PlaceNodes place_nodes;
    FindExtent find_extent;
    AskPrism ask_prism;
    // kernels/friction: Coulomb friction of the nodes of a block.
    FindFriction find_friction;
    FindResistance find_resistance;
    FindMoments find_moments;
    // kernels/indentation: nodes that a post drags along.
    FindIndentation find_indentation;
    FindIndentationGap find_indentation_gap;
};

// The rows that this processor can run, from the baseline to the fastest.
std::vector<SimdPath> simd_paths();

// The fastest of them.
extern const SimdPath simd;

}  // namespace birm3d
