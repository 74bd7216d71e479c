#include "kernels/indentation_dispatch.hpp"

#include "base/instruction_sets.hpp"

namespace birm3d {

// The functions of indentation_rows.cpp, for each instruction set that it is compiled for.
#define BIRM3D_DECLARE(set, runs)                                                                  \
    namespace set {                                                                                \
    void find_indentation(const IndentationNumbers&, const IndentationNumbers&, const PanelNodes&, \
                          const SeenColumns&);                                                     \
    double find_indentation_gap(const IndentationNumbers&, const PanelNodes&);                     \
    }
BIRM3D_INSTRUCTION_SETS(BIRM3D_DECLARE)

std::vector<IndentationFunctions> indentation_functions() {
    std::vector<IndentationFunctions> can;
#define BIRM3D_ADD(set, runs) \
    if (runs) can.push_back({#set, set::find_indentation, set::find_indentation_gap});
    BIRM3D_INSTRUCTION_SETS(BIRM3D_ADD)
    return can;
}

const IndentationFunctions indentation_rows = indentation_functions().back();

}  // namespace birm3d
