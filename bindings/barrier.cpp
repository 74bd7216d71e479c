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

// None or one: a barrier stands in one way.
std::optional<FreeStanding> only(const std::vector<FreeStanding>& free_standing) {
    if (free_standing.size() > 1)
        refuse("free_standing", "at most 1", static_cast<double>(free_standing.size()));
    return free_standing.empty() ? std::nullopt : std::optional(free_standing.front());
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
        .def_readonly("part_of", &Element::part_of, "index of the element that it is a part of, or None")
        .def_static(
            "plane",
            [](const InputArray& position, double heading) {
                return element(HalfSpace{}, position, heading);
            },
            py::kw_only(), py::arg("position"), py::arg("heading"),
            "A flat face without end; at heading 0 it looks to -x.")
        .def_static(
            "post",
            [](double radius, double height, const InputArray& position, double heading,
               std::optional<std::size_t> part_of, std::optional<double> opens) {
                Element post = element(Post(radius, height, opens), position, heading);
                post.part_of = part_of;
                return post;
            },
            py::kw_only(), py::arg("radius"), py::arg("height"), py::arg("position"), py::arg("heading"),
            py::arg("part_of") = std::nullopt, py::arg("opens") = std::nullopt,
            "Upright and round, foot of the axis at position; m. part_of: index of the element whose loads "
            "its own "
            "are added to. opens: of the edge of a wall, direction of the open space about it (rad).")
        .def_static(
            "prism",
            [](const InputArray& profile, double y_low, double y_high, bool covered_low_end,
               bool covered_high_end, const InputArray& position, double heading,
               std::optional<std::size_t> part_of, bool upright, bool draws_in_above) {
                Element prism = element(Prism(profile_points(profile), y_low, y_high,
                                              {.low_end = covered_low_end, .high_end = covered_high_end}),
                                        position, heading);
                prism.part_of = part_of;
                prism.upright = upright;
                prism.draws_in_above = draws_in_above;
                return prism;
            },
            py::kw_only(), py::arg("profile"), py::arg("y_low"), py::arg("y_high"),
            py::arg("covered_low_end"), py::arg("covered_high_end"), py::arg("position"), py::arg("heading"),
            py::arg("part_of") = std::nullopt, py::arg("upright") = false, py::arg("draws_in_above") = false,
            "profile: (n, 2) x and z of the corners (m), drawn along y from y_low to y_high; covered ends "
            "are no surface. part_of: as of a post. upright: own y points up, own z to lower y. "
            "draws_in_above: the "
            "skin above its vertical face towards -x is drawn in.")
        .def_static(
            "mesh",
            [](const InputArray& vertices, const std::vector<TriangleMesh::Face>& faces,
               const InputArray& position, double heading) {
                return element(TriangleMesh(points(vertices, "vertices"), faces), position, heading);
            },
            py::kw_only(), py::arg("vertices"), py::arg("faces"), py::arg("position"), py::arg("heading"),
            "vertices (n, 3) m, faces (m, 3), counter-clockwise seen from outside.");

    py::enum_<SegmentJoint>(m, "SegmentJoint", "What holds neighbouring free-standing segments together.")
        .value("pinned", SegmentJoint::pinned, "a pin at the middle of their ends; they turn freely about it")
        .value("loose", SegmentJoint::loose, "nothing");
    py::class_<FreeStanding>(m, "FreeStanding", "Segments that slide on the ground.")
        .def(py::init([](double density, double ground_friction, SegmentJoint joint) {
                 return FreeStanding{density, ground_friction, joint};
             }),
             py::kw_only(), py::arg("density"), py::arg("ground_friction"), py::arg("joint"),
             "density: kg/m^3; ground_friction: Coulomb coefficient.");
    py::class_<Segment>(m, "Segment", "A free-standing segment of a barrier.")
        .def_property_readonly(
            "mass", [](const Segment& s) { return s.body.mass; }, "kg")
        .def_property_readonly(
            "yaw_inertia", [](const Segment& s) { return s.body.inertia(2, 2); },
            "kg m^2, about the vertical through the mass centre")
        .def_readonly("mass_center_height", &Segment::mass_center_height, "m")
        .def_readonly("half_length", &Segment::half_length, "m")
        .def_readonly("half_base", &Segment::half_base, "m");

    py::class_<Barrier, std::shared_ptr<Barrier>>(m, "Barrier",
                                                  "Elements that stand on the ground. Immutable.")
        .def(
            py::init([](const std::vector<Element>& elements, double friction, const InputArray& origin,
                        double heading, const std::vector<FreeStanding>& free_standing) {
                return std::make_shared<Barrier>(elements, friction, vector(origin, "origin"), heading,
                                                 only(free_standing));
            }),
            py::kw_only(), py::arg("elements"), py::arg("friction"), py::arg("origin"), py::arg("heading"),
            py::arg("free_standing"),
            "friction: Coulomb coefficient; origin (3,) m on the barrier's line; heading of it about z, rad; "
            "free_standing: one, or none where the elements are fixed.")
        .def_property_readonly(
            "segments", [](const Barrier& barrier) { return barrier.segments; },
            "The elements where they are free-standing, else none.")
        .def_property_readonly(
            "normal", [](const Barrier& barrier) { return copy(barrier.normal()); },
            "(3,) of the barrier's line, towards the traffic, world axes");
}

}  // namespace birm3d::bindings
