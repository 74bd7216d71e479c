#include "kernels/detect_dispatch.hpp"

#include "base/instruction_sets.hpp"

namespace birm3d {

// The functions of detect_rows.cpp, for each instruction set that it is compiled for.
#define BIRM3D_DECLARE(set, runs)                                                          \
    namespace set {                                                                        \
    void place_nodes(const Turn&, const Points&, const Columns&, Extent&);                 \
    void find_extent(const Points&, Extent&);                                              \
    void ask_prism(const PrismView&, const Turn&, const Points&, double*, const Columns&); \
    }
BIRM3D_INSTRUCTION_SETS(BIRM3D_DECLARE)

std::vector<DetectFunctions> detect_functions() {
    std::vector<DetectFunctions> can;
#define BIRM3D_ADD(set, runs) \
    if (runs) can.push_back({#set, set::place_nodes, set::find_extent, set::ask_prism});
    BIRM3D_INSTRUCTION_SETS(BIRM3D_ADD)
    return can;
}

const DetectFunctions detect_rows = detect_functions().back();

}  // namespace birm3d
