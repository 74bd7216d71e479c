#include "birm3d/model/barrier.hpp"

#include <memory>

#include "arrays.hpp"
#include "register.hpp"

namespace birm3d::bindings {

void register_barrier(py::module_& m) {
    py::class_<Barrier, std::shared_ptr<Barrier>>(
        m, "Barrier", "A flat rigid wall or a pole, fixed to the ground. Immutable.")
        .def(py::init([](double friction, const InputArray& origin, double heading, double width,
                         double height) {
                 return std::make_shared<Barrier>(friction, vector(origin, "origin"), heading, width, height);
             }),
             py::kw_only(), py::arg("friction"), py::arg("origin"), py::arg("heading"), py::arg("width"),
             py::arg("height"),
             "friction: Coulomb coefficient; origin (3,) m on the face; heading of the barrier's line about "
             "z, rad.")
        .def_static(
            "pole",
            [](double friction, const InputArray& origin, double heading, double radius) {
                return std::make_shared<Barrier>(
                    Barrier::pole(friction, vector(origin, "origin"), heading, radius));
            },
            py::kw_only(), py::arg("friction"), py::arg("origin"), py::arg("heading"), py::arg("radius"),
            "An upright cylinder; origin (3,) m at the foot of its axis, radius m.")
        .def_property_readonly(
            "normal", [](const Barrier& barrier) { return copy(barrier.normal()); },
            "(3,) of the barrier's line, towards the traffic, world axes");
}

}  // namespace birm3d::bindings
