// One function for each bound file; called once by the module.
#pragma once

#include <pybind11/pybind11.h>

namespace birm3d::bindings {

void register_errors(pybind11::module_& m);
void register_geometry(pybind11::module_& m);
void register_laws(pybind11::module_& m);
void register_vehicle(pybind11::module_& m);
void register_barrier(pybind11::module_& m);
void register_settings(pybind11::module_& m);
void register_event(pybind11::module_& m);
void register_extremes(pybind11::module_& m);
void register_history(pybind11::module_& m);
void register_simulation(pybind11::module_& m);
void register_runner(pybind11::module_& m);

}  // namespace birm3d::bindings
