// The functions of friction_rows.cpp of which those serve that the processor can run.
#pragma once

#include <vector>

#include "kernels/friction_rows.hpp"

namespace birm3d {

struct FrictionFunctions {
    const char* instruction_set;
    FindFriction find_friction;
    FindResistance find_resistance;
    FindMoments find_moments;
};

// Those that the processor can run, the best one last; all give the same bits.
std::vector<FrictionFunctions> friction_functions();

// For the processor that runs.
extern const FrictionFunctions friction_rows;

}  // namespace birm3d
