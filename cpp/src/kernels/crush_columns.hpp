// The columns of a mesh and of its state as the plain pointers that kernels/crush_simd.hpp takes.
#pragma once

#include "birm3d/model/truss_mesh.hpp"
#include "kernels/crush_simd.hpp"

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
            mesh.recovers ? truss.recovery.data() : nullptr,
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

}  // namespace birm3d
