// The functions of indentation_rows.cpp of which those serve that the processor can run.
#pragma once

#include <vector>

#include "kernels/indentation_rows.hpp"

namespace birm3d {

struct IndentationFunctions {
    const char* instruction_set;
    FindIndentation find_indentation;
    FindIndentationGap find_indentation_gap;
};

// Those that the processor can run, the best one last; all give the same bits.
std::vector<IndentationFunctions> indentation_functions();

// For the processor that runs.
extern const IndentationFunctions indentation_rows;

}  // namespace birm3d
