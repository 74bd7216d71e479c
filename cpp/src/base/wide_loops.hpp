// Loops over columns in the widest registers of the processor, for code outside the kernels.
//
// Unlike *_simd.cpp, which are compiled once for each instruction set, the loop is one function here that is compiled
// several times. All that it calls is inlined, so that no symbol of the wider instructions can be shared with other files.
// Contraction is off and sums keep their order: all give the same bits.
#pragma once

namespace birm3d {

#if defined(BIRM3D_X86_PATHS) && defined(__GNUC__)

template <class Loop>
__attribute__((target("avx2"), flatten)) void run_with_avx2(const Loop& loop) {
    loop();
}

#if !defined(BIRM3D_UP_TO_AVX2)
template <class Loop>
__attribute__((target("avx512f"), flatten)) void run_with_avx512(const Loop& loop) {
    loop();
}
#endif

template <class Loop>
void run_wide(const Loop& loop) {
#if !defined(BIRM3D_UP_TO_AVX2)
    if (__builtin_cpu_supports("avx512f")) return run_with_avx512(loop);
#endif
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
