// The functions of dent_rows.cpp of which those serve that the processor can run.
#pragma once

#include <vector>

#include "kernels/dent_rows.hpp"

namespace birm3d {

struct DentFunctions {
    const char* instruction_set;
    FindDent find_dent;
    FindDentGap find_dent_gap;
};

// Those that the processor can run, the best one last; all give the same bits.
std::vector<DentFunctions> dent_functions();

// For the processor that runs.
extern const DentFunctions dent_rows;

}  // namespace birm3d
