// Which functions of crush_rows.cpp serve the processor that runs.
#pragma once

#include <vector>

#include "kernels/crush_rows.hpp"

namespace birm3d {

// The two functions for one instruction set.
struct PressFunctions {
    const char* instruction_set;
    Press<FlatPress> flat;
    Press<CurvedPress> curved;
};

// Those that the processor can run, the best one last; all give the same bits.
std::vector<PressFunctions> press_functions();

// For the processor that runs.
extern const PressFunctions press_rows;

}  // namespace birm3d
