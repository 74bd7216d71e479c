// The instruction sets that some files are compiled for (base/row.hpp), for those that choose between their functions.
#pragma once

// BIRM3D_INSTRUCTION_SETS(each) is each(name, can this processor run it?) for all of them, the best one last.
#if !defined(BIRM3D_X86_PATHS)
#define BIRM3D_INSTRUCTION_SETS(each) each(baseline, true)
#elif defined(BIRM3D_UP_TO_AVX2)
#define BIRM3D_INSTRUCTION_SETS(each) each(baseline, true) each(avx2, __builtin_cpu_supports("avx2"))
#else
#define BIRM3D_INSTRUCTION_SETS(each)                               \
    each(baseline, true) each(avx2, __builtin_cpu_supports("avx2")) \
        each(avx512f, __builtin_cpu_supports("avx512f"))
#endif
