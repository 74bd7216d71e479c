// Values of trusses in the caller's order: the core keeps them in blocks of neighbours.
#pragma once

#include <utility>

#include "arrays.hpp"
#include "birm3d/model/truss_mesh.hpp"

namespace birm3d::bindings {

// (n) Of each truss what `value` returns for its block and its place there; read-only.
template <class Value>
OutputArray in_input_order(const TrussMesh& mesh, const Value& value) {
    OutputArray result(static_cast<py::ssize_t>(mesh.count));
    auto at = result.mutable_unchecked<1>();
    for (std::size_t truss = 0; truss < mesh.count; ++truss) {
        const std::size_t i = mesh.slot(truss);
        at(static_cast<py::ssize_t>(mesh.input_index[truss])) = value(i / block_size, i % block_size);
    }
    return read_only(std::move(result));
}

}  // namespace birm3d::bindings
