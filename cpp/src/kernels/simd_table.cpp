#include "kernels/simd_table.hpp"

// BIRM3D_INSTRUCTION_SETS(each) is each(name, can this processor run it?) for all instruction sets, the fastest last.
#if !defined(BIRM3D_X86_PATHS)
#define BIRM3D_INSTRUCTION_SETS(each) each(baseline, true)
#elif defined(BIRM3D_UP_TO_AVX2)
#define BIRM3D_INSTRUCTION_SETS(each) each(baseline, true) each(avx2, __builtin_cpu_supports("avx2"))
#else
#define BIRM3D_INSTRUCTION_SETS(each)                               \
    each(baseline, true) each(avx2, __builtin_cpu_supports("avx2")) \
        each(avx512f, __builtin_cpu_supports("avx512f"))
#endif

namespace birm3d {

// The functions of kernels/*_simd.cpp, which are compiled once for each instruction set.
#define BIRM3D_DECLARE(set, runs)                                                                       \
    namespace set {                                                                                     \
    PressedNodes press_flat(const PressColumns&, const FlatPress&, const PressState<const double>&,     \
                            const PressState<double>&, double*, double*, NodeSums&);                    \
    PressedNodes press_curved(const PressColumns&, const CurvedPress&, const PressState<const double>&, \
                              const PressState<double>&, double*, double*, NodeSums&);                  \
    void place_nodes(const PlainPlacement&, const Points&, const Columns&, Extent&);                    \
    void find_extent(const Points&, Extent&);                                                           \
    void ask_prism(const PrismView&, const PlainPlacement&, const Points&, double*, const Columns&);    \
    FrictionSums find_friction(const Sliding&, const SlidingNodes&, double*);                           \
    ResistanceSums find_resistance(const double*, const SlidingNodes&);                                 \
    Moments find_moments(const double*, const SlidingNodes&);                                           \
    void find_indentation(const IndentationNumbers&, const IndentationNumbers&, const PanelNodes&,      \
                          const KnownFaces&);                                                           \
    double find_indentation_gap(const IndentationNumbers&, const PanelNodes&);                          \
    }
BIRM3D_INSTRUCTION_SETS(BIRM3D_DECLARE)

std::vector<SimdPath> simd_paths() {
    std::vector<SimdPath> paths;
#define BIRM3D_ADD(set, runs)                                                                          \
    if (runs)                                                                                          \
        paths.push_back({#set, set::press_flat, set::press_curved, set::place_nodes, set::find_extent, \
                         set::ask_prism, set::find_friction, set::find_resistance, set::find_moments,  \
                         set::find_indentation, set::find_indentation_gap});
    BIRM3D_INSTRUCTION_SETS(BIRM3D_ADD)
    return paths;
}

namespace {

// Nothing can run if there is no memory for three rows; the program may end here.
SimdPath fastest() noexcept {
    return simd_paths().back();
}

}  // namespace

const SimdPath simd = fastest();

}  // namespace birm3d
