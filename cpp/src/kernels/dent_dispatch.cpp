#include "kernels/dent_dispatch.hpp"

#include "base/instruction_sets.hpp"

namespace birm3d {

// The functions of dent_rows.cpp, for each instruction set that it is compiled for.
#define BIRM3D_DECLARE(set, runs)                                                                  \
    namespace set {                                                                                \
    void find_dent(const DentNumbers&, const DentNumbers&, const PanelNodes&, const SeenColumns&); \
    double find_dent_gap(const DentNumbers&, const PanelNodes&);                                   \
    }
BIRM3D_INSTRUCTION_SETS(BIRM3D_DECLARE)

std::vector<DentFunctions> dent_functions() {
    std::vector<DentFunctions> can;
#define BIRM3D_ADD(set, runs) \
    if (runs) can.push_back({#set, set::find_dent, set::find_dent_gap});
    BIRM3D_INSTRUCTION_SETS(BIRM3D_ADD)
    return can;
}

const DentFunctions dent_rows = dent_functions().back();

}  // namespace birm3d
