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
template <class Kind>
std::optional<Kind> only(const char* name, const std::vector<Kind>& given) {
    if (given.size() > 1) refuse(name, "at most 1", static_cast<double>(given.size()));
    return given.empty() ? std::nullopt : std::optional(given.front());
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
    py::class_<YieldingPosts>(m, "YieldingPosts",
                              "Posts that tilt about their centre of rotation against a plastic moment.")
        .def(py::init([](double mass, double inertia, double plastic_moment) {
                 return YieldingPosts{mass, inertia, plastic_moment};
             }),
             py::kw_only(), py::arg("mass"), py::arg("inertia"), py::arg("plastic_moment"),
             "mass: kg; inertia: about a horizontal axis through the centre of rotation, kg m^2; "
             "plastic_moment: N m.")
        .def_readonly("plastic_moment", &YieldingPosts::plastic_moment, "N m");
    py::class_<MovingElement>(m, "Segment", "A free-standing segment of a barrier, or a post that yields.")
        .def_property_readonly(
            "mass", [](const MovingElement& s) { return s.body.mass; }, "kg")
        .def_property_readonly(
            "yaw_inertia", [](const MovingElement& s) { return s.body.inertia(2, 2); },
            "kg m^2, about the vertical through the mass centre")
        .def_readonly("mass_center_height", &MovingElement::mass_center_height, "m")
        .def_readonly("half_length", &MovingElement::half_length, "m")
        .def_readonly("half_base", &MovingElement::half_base, "m")
        .def_readonly("plastic_moment", &MovingElement::plastic_moment,
                      "N m, of a post that yields; else infinite");

    py::class_<Barrier, std::shared_ptr<Barrier>>(m, "Barrier",
                                                  "Elements that stand on the ground. Immutable.")
        .def(
            py::init([](const std::vector<Element>& elements, double friction, const InputArray& origin,
                        double heading, const std::vector<FreeStanding>& free_standing,
                        const std::vector<YieldingPosts>& yielding) {
                return std::make_shared<Barrier>(elements, friction, vector(origin, "origin"), heading,
                                                 only("free_standing", free_standing),
                                                 only("yielding", yielding));
            }),
            py::kw_only(), py::arg("elements"), py::arg("friction"), py::arg("origin"), py::arg("heading"),
            py::arg("free_standing"), py::arg("yielding") = std::vector<YieldingPosts>{},
            "friction: Coulomb coefficient; origin (3,) m on the barrier's line; heading of it about z, rad; "
            "free_standing, yielding: one, or none where the elements do not slide, or do not yield.")
        .def_property_readonly(
            "segments",
            [](const Barrier& barrier) {
                return barrier.free_standing ? barrier.moving_elements : std::vector<MovingElement>{};
            },
            "The elements where they are free-standing, else none.")
        .def_property_readonly(
            "yielding_posts",
            [](const Barrier& barrier) {
                return barrier.yielding ? barrier.moving_elements : std::vector<MovingElement>{};
            },
            "The elements where they are posts that yield, else none.")
        .def_property_readonly(
            "normal", [](const Barrier& barrier) { return copy(barrier.normal()); },
            "(3,) of the barrier's line, towards the traffic, world axes")
        .def_property_readonly(
            "top", &Barrier::top,
            "greatest height above the ground (m); infinite for half-spaces and endless posts");
}

}  // namespace birm3d::bindings
