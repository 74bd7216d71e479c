// The functions of detect_rows.cpp of which those serve that the processor can run.
#pragma once

#include <vector>

#include "kernels/detect_rows.hpp"

namespace birm3d {

struct DetectFunctions {
    const char* instruction_set;
    PlaceNodes place_nodes;
    FindExtent find_extent;
    AskPrism ask_prism;
};

// Those that the processor can run, the best one last; all give the same bits.
std::vector<DetectFunctions> detect_functions();

// For the processor that runs.
extern const DetectFunctions detect_rows;

}  // namespace birm3d
