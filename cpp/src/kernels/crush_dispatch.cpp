#include "kernels/crush_dispatch.hpp"

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
#if !defined(BIRM3D_UP_TO_AVX2)
BIRM3D_DECLARE(avx512f)
#endif
#endif
#undef BIRM3D_DECLARE

std::vector<PressFunctions> press_functions() {
    std::vector<PressFunctions> can{{"baseline", baseline::press_flat, baseline::press_curved}};
#if defined(BIRM3D_X86_PATHS)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2")) can.push_back({"avx2", avx2::press_flat, avx2::press_curved});
#if !defined(BIRM3D_UP_TO_AVX2)
    if (__builtin_cpu_supports("avx512f"))
        can.push_back({"avx512f", avx512f::press_flat, avx512f::press_curved});
#endif
#endif
    return can;
}

const PressFunctions press_rows = press_functions().back();

}  // namespace birm3d
