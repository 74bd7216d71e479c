#include "kernels/crush_rows.hpp"

namespace birm3d {

// One declaration for each instruction set that crush_rows.cpp is compiled for.
namespace baseline {
double press_flat(const PressColumns&, const FlatSurface&, const PressState<const double>&,
                  const PressState<double>&, double*, double*, NodeSums&);
}
#if defined(BIRM3D_X86_PATHS)
namespace avx2 {
double press_flat(const PressColumns&, const FlatSurface&, const PressState<const double>&,
                  const PressState<double>&, double*, double*, NodeSums&);
}
namespace avx512 {
double press_flat(const PressColumns&, const FlatSurface&, const PressState<const double>&,
                  const PressState<double>&, double*, double*, NodeSums&);
}
#endif

namespace {

PressFlat best() {
#if defined(BIRM3D_X86_PATHS)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f")) return avx512::press_flat;
    if (__builtin_cpu_supports("avx2")) return avx2::press_flat;
#endif
    return baseline::press_flat;
}

}  // namespace

const PressFlat press_flat = best();

}  // namespace birm3d
