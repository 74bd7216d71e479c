#include "kernels/crush_rows.hpp"

namespace birm3d {

// The functions of crush_rows.cpp, for each instruction set that it is compiled for.
#define BIRM3D_DECLARE(instruction_set)                                                           \
    namespace instruction_set {                                                                   \
    double press_flat(const PressColumns&, const FlatPress&, const PressState<const double>&,     \
                      const PressState<double>&, double*, double*, NodeSums&);                    \
    double press_curved(const PressColumns&, const CurvedPress&, const PressState<const double>&, \
                        const PressState<double>&, double*, double*, NodeSums&);                  \
    }
BIRM3D_DECLARE(baseline)
#if defined(BIRM3D_X86_PATHS)
BIRM3D_DECLARE(avx2)
BIRM3D_DECLARE(avx512)
#endif
#undef BIRM3D_DECLARE

namespace {

struct Functions {
    Press<FlatPress> flat;
    Press<CurvedPress> curved;
};

Functions best() {
#if defined(BIRM3D_X86_PATHS)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f")) return {avx512::press_flat, avx512::press_curved};
    if (__builtin_cpu_supports("avx2")) return {avx2::press_flat, avx2::press_curved};
#endif
    return {baseline::press_flat, baseline::press_curved};
}

const Functions functions = best();

}  // namespace

const Press<FlatPress> press_flat = functions.flat;
const Press<CurvedPress> press_curved = functions.curved;

}  // namespace birm3d
