#include "register.hpp"

PYBIND11_MODULE(_core, m) {
    m.doc() = "The BIRM3D core: SI units, angles in radians. Use the birm3d package, which wraps it.";
    using namespace birm3d::bindings;
    register_errors(m);
    register_geometry(m);
    register_laws(m);
    register_vehicle(m);
    register_barrier(m);
    register_settings(m);
    register_event(m);
    register_extremes(m);
    register_history(m);
    register_simulation(m);
    register_runner(m);
}
