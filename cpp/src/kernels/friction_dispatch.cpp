#include "kernels/friction_dispatch.hpp"

#include "base/instruction_sets.hpp"

namespace birm3d {

// The functions of friction_rows.cpp, for each instruction set that it is compiled for.
#define BIRM3D_DECLARE(set, runs)                                            \
    namespace set {                                                          \
    FrictionSums find_friction(const Sliding&, const RubbedNodes&, double*); \
    ResistanceSums find_resistance(const double*, const RubbedNodes&);       \
    Moments find_moments(const double*, const RubbedNodes&);                 \
    }
BIRM3D_INSTRUCTION_SETS(BIRM3D_DECLARE)

std::vector<FrictionFunctions> friction_functions() {
    std::vector<FrictionFunctions> can;
#define BIRM3D_ADD(set, runs) \
    if (runs) can.push_back({#set, set::find_friction, set::find_resistance, set::find_moments});
    BIRM3D_INSTRUCTION_SETS(BIRM3D_ADD)
    return can;
}

const FrictionFunctions friction_rows = friction_functions().back();

}  // namespace birm3d
