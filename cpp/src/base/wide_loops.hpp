// Loops over columns in the widest registers of the processor, for code outside the kernels.
//
// Unlike *_simd.cpp, which are compiled once for each instruction set, the loop is one function here that is compiled
// twice. All that it calls is inlined, so that no symbol of the wider instructions can be shared with other files.
// Contraction is off and sums keep their order: both give the same bits.
//
// With AVX2 a run of 40 trusses takes 6 % less time, of which recording is a large part. A car at a wall at 25 degrees takes 1 %
// less. kernels/simd_table.hpp has the gain of the other loops.
#pragma once

namespace birm3d {

#if defined(BIRM3D_X86_PATHS) && defined(__GNUC__)

template <class Loop>
__attribute__((target("avx2"), flatten)) void run_with_avx2(const Loop& loop) {
    loop();
}

template <class Loop>
void run_wide(const Loop& loop) {
    if (__builtin_cpu_supports("avx2"))
        run_with_avx2(loop);
    else
        loop();
}

#else

template <class Loop>
void run_wide(const Loop& loop) {
    loop();
}

#endif

}  // namespace birm3d
