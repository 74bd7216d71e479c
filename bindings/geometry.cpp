#include <pybind11/stl.h>

#include "arrays.hpp"
#include "birm3d/base/rotation.hpp"
#include "birm3d/model/mass_properties.hpp"
#include "register.hpp"

namespace birm3d::bindings {

namespace {

std::vector<Hexahedron> solids(const InputArray& array) {
    if (array.ndim() != 3 || array.shape(1) != 8 || array.shape(2) != 3)
        refuse("solids shape", "(n, 8, 3)", shape_text(array));
    std::vector<Hexahedron> result(static_cast<std::size_t>(array.shape(0)));
    const auto at = array.unchecked<3>();
    for (std::size_t s = 0; s < result.size(); ++s)
        for (std::size_t node = 0; node < 8; ++node)
            for (int axis = 0; axis < 3; ++axis)
                result[s][node][axis] = at(static_cast<py::ssize_t>(s), static_cast<py::ssize_t>(node), axis);
    return result;
}

}  // namespace

void register_geometry(py::module_& m) {
    py::class_<MassProperties>(m, "MassProperties", "Mass, mass centre and inertia about it (paper Eq. 2-7).")
        .def_readonly("mass", &MassProperties::mass, "kg")
        .def_property_readonly(
            "center_of_mass", [](const MassProperties& p) { return copy(p.center_of_mass); }, "(3,) m")
        .def_property_readonly(
            "inertia", [](const MassProperties& p) { return copy(p.inertia); }, "(3, 3) kg m^2");

    m.def(
        "mass_properties",
        [](const InputArray& nodes, const InputArray& densities) {
            return mass_properties(solids(nodes), numbers(densities, "densities"));
        },
        py::arg("solids"), py::arg("densities"),
        "Mass properties of 8-node solids (n, 8, 3) in m with densities (n,) in kg/m^3.");
    m.def(
        "solid_volumes",
        [](const InputArray& nodes) {
            Column volumes;
            for (const Hexahedron& solid : solids(nodes))
                volumes.push_back(solid_volume(solid, volumes.size()));
            return py::array_t<double>(static_cast<py::ssize_t>(volumes.size()), volumes.data());
        },
        py::arg("solids"), "Volumes (n,) in m^3 of 8-node solids (n, 8, 3).");
    m.def(
        "roll_pitch_yaw",
        [](double w, double x, double y, double z) {
            const Angles a = roll_pitch_yaw(Quat(w, x, y, z).normalized());
            return py::make_tuple(a.roll, a.pitch, a.yaw);
        },
        py::arg("w"), py::arg("x"), py::arg("y"), py::arg("z"), "ISO 8855 angles in rad of a quaternion.");
    m.def(
        "from_roll_pitch_yaw",
        [](double roll, double pitch, double yaw) {
            const Quat q = from_roll_pitch_yaw({roll, pitch, yaw});
            return py::make_tuple(q.w(), q.x(), q.y(), q.z());
        },
        py::arg("roll"), py::arg("pitch"), py::arg("yaw"),
        "Quaternion (w, x, y, z) of ISO 8855 angles in rad.");
}

}  // namespace birm3d::bindings
