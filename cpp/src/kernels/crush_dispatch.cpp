#include "kernels/crush_dispatch.hpp"

#include "base/instruction_sets.hpp"

namespace birm3d {

// The functions of crush_rows.cpp, for each instruction set that it is compiled for.
#define BIRM3D_DECLARE(set, runs)                                                                       \
    namespace set {                                                                                     \
    PressedNodes press_flat(const PressColumns&, const FlatPress&, const PressState<const double>&,     \
                            const PressState<double>&, double*, double*, NodeSums&);                    \
    PressedNodes press_curved(const PressColumns&, const CurvedPress&, const PressState<const double>&, \
                              const PressState<double>&, double*, double*, NodeSums&);                  \
    }
BIRM3D_INSTRUCTION_SETS(BIRM3D_DECLARE)

std::vector<PressFunctions> press_functions() {
    std::vector<PressFunctions> can;
#define BIRM3D_ADD(set, runs) \
    if (runs) can.push_back({#set, set::press_flat, set::press_curved});
    BIRM3D_INSTRUCTION_SETS(BIRM3D_ADD)
    return can;
}

const PressFunctions press_rows = press_functions().back();

}  // namespace birm3d
