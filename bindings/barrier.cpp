#include "birm3d/model/barrier.hpp"

#include <pybind11/stl.h>

#include <memory>

#include "arrays.hpp"
#include "register.hpp"

namespace birm3d::bindings {

namespace {

Element element(Shape shape, const InputArray& position, double heading) {
    return {std::move(shape), vector(position, "position"), heading};
}

Prism::Profile profile_points(const InputArray& array) {
    if (array.ndim() != 2 || array.shape(1) != 2) refuse("profile shape", "(n, 2)", shape_text(array));
    Prism::Profile profile;
    for (py::ssize_t i = 0; i < array.shape(0); ++i)
        profile.emplace_back(array.at(i, 0), array.at(i, 1));
    return profile;
}

}  // namespace

void register_barrier(py::module_& m) {
    py::class_<Element>(m, "Element", "A piece of a barrier: own axes at position, turned by heading (rad).")
        .def_static(
            "plane",
            [](const InputArray& position, double heading) {
                return element(HalfSpace{}, position, heading);
            },
            py::kw_only(), py::arg("position"), py::arg("heading"),
            "A flat face without end; at heading 0 it looks to -x.")
        .def_static(
            "post",
            [](double radius, double height, const InputArray& position, double heading) {
                return element(Post(radius, height), position, heading);
            },
            py::kw_only(), py::arg("radius"), py::arg("height"), py::arg("position"), py::arg("heading"),
            "Upright and round, foot of the axis at position; m.")
        .def_static(
            "prism",
            [](const InputArray& profile, double y_low, double y_high,
               const std::vector<std::size_t>& covered_edges, bool covered_low_end, bool covered_high_end,
               const InputArray& position, double heading) {
                return element(Prism(profile_points(profile), y_low, y_high,
                                     {covered_edges, covered_low_end, covered_high_end}),
                               position, heading);
            },
            py::kw_only(), py::arg("profile"), py::arg("y_low"), py::arg("y_high"), py::arg("covered_edges"),
            py::arg("covered_low_end"), py::arg("covered_high_end"), py::arg("position"), py::arg("heading"),
            "profile: (n, 2) x and z of the corners (m), drawn along y from y_low to y_high; covered faces "
            "are "
            "no surface.")
        .def_static(
            "mesh",
            [](const InputArray& vertices, const std::vector<TriangleMesh::Face>& faces,
               const InputArray& position, double heading) {
                return element(TriangleMesh(points(vertices, "vertices"), faces), position, heading);
            },
            py::kw_only(), py::arg("vertices"), py::arg("faces"), py::arg("position"), py::arg("heading"),
            "vertices (n, 3) m, faces (m, 3), counter-clockwise seen from outside.");

    py::class_<Barrier, std::shared_ptr<Barrier>>(m, "Barrier",
                                                  "Elements that stand on the ground. Immutable.")
        .def(
            py::init([](const std::vector<Element>& elements, double friction, const InputArray& origin,
                        double heading) {
                return std::make_shared<Barrier>(elements, friction, vector(origin, "origin"), heading);
            }),
            py::kw_only(), py::arg("elements"), py::arg("friction"), py::arg("origin"), py::arg("heading"),
            "friction: Coulomb coefficient; origin (3,) m on the barrier's line; heading of it about z, rad.")
        .def_property_readonly(
            "normal", [](const Barrier& barrier) { return copy(barrier.normal()); },
            "(3,) of the barrier's line, towards the traffic, world axes");
}

}  // namespace birm3d::bindings
