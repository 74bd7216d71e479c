// A block of `lanes` neighbouring trusses is the unit of work of the kernels.
//
// Loops over lanes are compiled for several instruction sets and chosen once, when the library is loaded.
// Contraction is off and sums run in a fixed order, so every choice gives the same bits.
#pragma once

#include <array>
#include <cstddef>

namespace birm3d {

inline constexpr std::size_t lanes = 64;

using Lanes = std::array<double, lanes>;

// On functions of plain loops only: inlined Eigen code would keep the baseline's packets, and its symbols
// could clash between instruction sets.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GLIBC__)
#define BIRM3D_LANE_LOOP \
    __attribute__((noinline, target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define BIRM3D_LANE_LOOP
#endif

// Before a loop: its iterations do not touch each other's data, so no run-time overlap tests are needed.
#if defined(__clang__)
#define BIRM3D_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define BIRM3D_INDEPENDENT _Pragma("GCC ivdep")
#else
#define BIRM3D_INDEPENDENT
#endif

// Helpers of lane loops must be compiled with the loop they stand in.
#if defined(__GNUC__)
#define BIRM3D_IN_LANE_LOOP inline __attribute__((always_inline))
#else
#define BIRM3D_IN_LANE_LOOP inline
#endif

// Eight running sums, then pairs.
BIRM3D_IN_LANE_LOOP double lane_sum(const Lanes& values) {
    std::array<double, 8> sum{};
    for (std::size_t row = 0; row < lanes; row += 8)
        for (std::size_t i = 0; i < 8; ++i)
            sum[i] += values[row + i];
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}

}  // namespace birm3d
