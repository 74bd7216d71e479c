// Loops over the nodes of a block. Contraction is off and sums run in a fixed order, so that every instruction set gives the
// same bits.
#pragma once

#include "base/node_sums.hpp"
#include "birm3d/base/block.hpp"

namespace birm3d {

// The compiler clones such a function for each instruction set and chooses when the library is loaded. Only for
// functions of plain loops: inlined Eigen code would keep the baseline's packets, and its symbols could clash.
// tests/bench/bench_simd.py measures the gain; BIRM3D_PLAIN_BLOCKS leaves the clones out.
#if defined(__clang__)
#define BIRM3D_CLONES(...) \
    __attribute__((target_clones(__VA_ARGS__)))  // never inlined, and not to be told so
#else
#define BIRM3D_CLONES(...) __attribute__((noinline, target_clones(__VA_ARGS__)))
#endif
#if defined(BIRM3D_BASELINE) || defined(BIRM3D_PLAIN_BLOCKS)
#define BIRM3D_BLOCK_LOOP __attribute__((noinline))
#elif defined(__x86_64__) && defined(__gnu_linux__) && defined(__GLIBC__) && defined(BIRM3D_UP_TO_AVX2)
#define BIRM3D_BLOCK_LOOP BIRM3D_CLONES("arch=x86-64-v3", "default")
#elif defined(__x86_64__) && defined(__gnu_linux__) && defined(__GLIBC__)
#define BIRM3D_BLOCK_LOOP BIRM3D_CLONES("arch=x86-64-v4", "arch=x86-64-v3", "default")
#else
#define BIRM3D_BLOCK_LOOP
#endif

// Before a loop: its iterations do not touch each other's data, so no run-time overlap tests are needed.
#if defined(__clang__)
#define BIRM3D_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define BIRM3D_INDEPENDENT _Pragma("GCC ivdep")
#else
#define BIRM3D_INDEPENDENT
#endif

// Sum by halves, in place: a fixed order that every instruction set can follow.
BIRM3D_INLINE double block_sum(BlockColumn& values) {
    for (std::size_t half = block_size / 2; half >= 8; half /= 2) {
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < half; ++i)
            values[i] += values[half + i];
    }
    return packet_sum(values.data());
}

// The greatest, in place.
BIRM3D_INLINE double block_max(BlockColumn& values) {
    for (std::size_t half = block_size / 2; half > 0; half /= 2) {
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < half; ++i)
            values[i] = values[half + i] > values[i] ? values[half + i] : values[i];
    }
    return values[0];
}

}  // namespace birm3d
