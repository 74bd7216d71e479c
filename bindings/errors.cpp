#include "birm3d/base/error.hpp"

#include "bound_simulation.hpp"
#include "register.hpp"

namespace birm3d::bindings {

// InvalidArgument derives from std::invalid_argument, which pybind11 turns into ValueError by itself.
void register_errors(pybind11::module_& m) {
    pybind11::register_exception<UnstableError>(m, "UnstableError", PyExc_ValueError).doc() =
        "A fixed time step is longer than the stable one, or a scene is too stiff for any step.";
    pybind11::register_exception<BusyError>(m, "BusyError", PyExc_RuntimeError).doc() =
        "Another thread uses the simulation.";
}

}  // namespace birm3d::bindings
