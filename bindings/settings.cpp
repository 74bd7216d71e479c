#include "birm3d/model/settings.hpp"

#include <pybind11/stl.h>

#include "birm3d/base/tolerances.hpp"
#include "register.hpp"

namespace birm3d::bindings {

namespace py = pybind11;

void register_settings(py::module_& m) {
    py::enum_<ContactModel>(m, "ContactModel")
        .value("projected", ContactModel::projected)
        .value("along_truss", ContactModel::along_truss);
    py::enum_<TireModel>(m, "TireModel").value("slip", TireModel::slip).value("skid", TireModel::skid);

    py::class_<Settings>(m, "Settings", "How a scene is computed (SI). Immutable.")
        .def(py::init([](std::optional<double> time_step, double tolerance, double output_interval,
                         double gravity, bool ground, double mu_tire, double mu_body, double mu_tire_barrier,
                         double braking, double cornering_stiffness, double restitution,
                         ContactModel contact_model, TireModel tire_model) {
                 const Settings settings{
                     time_step,   tolerance,     output_interval, gravity, ground,
                     mu_tire,     mu_body,       mu_tire_barrier, braking, cornering_stiffness,
                     restitution, contact_model, tire_model};
                 require_valid(settings);
                 return settings;
             }),
             py::kw_only(), py::arg("time_step"), py::arg("tolerance"), py::arg("output_interval"),
             py::arg("gravity"), py::arg("ground"), py::arg("mu_tire"), py::arg("mu_body"),
             py::arg("mu_tire_barrier"), py::arg("braking"), py::arg("cornering_stiffness"),
             py::arg("restitution"), py::arg("contact_model"), py::arg("tire_model"));
    // s: so long a run goes on once its outcome is known.
    m.attr("tail_duration") = tolerance::tail_duration;
    m.attr("along_line") = tolerance::along_line;
}

}  // namespace birm3d::bindings
