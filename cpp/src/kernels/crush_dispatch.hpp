// Between the columns of a mesh and its state and the functions of crush_rows.cpp, of which those serve that the
// processor can run.
#pragma once

#include <vector>

#include "birm3d/model/truss_mesh.hpp"
#include "kernels/crush_rows.hpp"

namespace birm3d {

// The columns of block `b`; `factor` may be null.
inline PressColumns columns_of(const TrussMesh& mesh, std::size_t b, const BlockColumn* factor) {
    const TrussBlock& truss = mesh.block[b];
    return {truss.anchor_x.data(),
            truss.anchor_y.data(),
            truss.anchor_z.data(),
            truss.length.data(),
            truss.k_unloading.data(),
            truss.compliance.data(),
            mesh.recovers ? truss.per_recovery.data() : nullptr,
            mesh.hinge[b * mesh.hinges].deflection.data(),
            mesh.hinges,
            factor ? factor->data() : nullptr};
}

template <class Number, class State>
PressState<Number> columns_of(State& state) {
    return {state.x.data(),          state.y.data(),        state.z.data(),
            state.deflection.data(), state.force.data(),    state.peak_deflection.data(),
            state.residual.data(),   state.unloading.data()};
}

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
