#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "birm3d/model/vehicle.hpp"
#include "input_order.hpp"
#include "register.hpp"

namespace birm3d::bindings {

namespace {

using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

template <class T>
std::vector<T> integers(const Integers& array, const char* name) {
    if (array.ndim() != 1) refuse(std::string(name) + " shape", "(n,)", shape_text(array));
    std::vector<T> result;
    result.reserve(static_cast<std::size_t>(array.shape(0)));
    for (py::ssize_t i = 0; i < array.shape(0); ++i)
        result.push_back(static_cast<T>(array.at(i)));
    return result;
}

void require_row_for_each(const std::vector<Wheel>& wheels, const InputArray& numbers, py::ssize_t columns,
                          const std::string& name) {
    if (numbers.ndim() != 2 || numbers.shape(1) != columns ||
        numbers.shape(0) != static_cast<py::ssize_t>(wheels.size()))
        refuse(name + " shape", "(w, " + std::to_string(columns) + "), a row for each wheel",
               shape_text(numbers));
}

std::vector<Wheel> discs(const InputArray& wheels) {
    if (wheels.ndim() != 2 || wheels.shape(1) != 4) refuse("wheels shape", "(w, 4)", shape_text(wheels));
    std::vector<Wheel> result;
    result.reserve(static_cast<std::size_t>(wheels.shape(0)));
    for (py::ssize_t i = 0; i < wheels.shape(0); ++i) {
        Wheel& wheel = result.emplace_back();
        wheel.center = {wheels.at(i, 0), wheels.at(i, 1), wheels.at(i, 2)};
        wheel.radius = wheels.at(i, 3);
    }
    return result;
}

std::vector<SlideKnot> slide_knots(const InputArray& slide) {
    if (slide.ndim() != 2 || slide.shape(1) != 2) refuse("slide shape", "(n, 2)", shape_text(slide));
    std::vector<SlideKnot> knots;
    knots.reserve(static_cast<std::size_t>(slide.shape(0)));
    for (py::ssize_t i = 0; i < slide.shape(0); ++i)
        knots.push_back({slide.at(i, 0), slide.at(i, 1)});
    return knots;
}

}  // namespace

void register_vehicle(py::module_& m) {
    py::class_<TrussMesh>(m, "TrussMesh", "The crushable skin of one rigid body. Immutable.")
        .def(py::init([](const InputArray& nodes, const InputArray& anchors,
                         const std::vector<TrussCurve>& curves, const Integers& curve_of,
                         const InputArray& scale, const InputArray& wheels, double rate_sensitivity,
                         double indentation_length, const Integers& wheel_of, const Integers& along_of) {
                 TrussInput trusses{points(nodes, "nodes"), points(anchors, "anchors"), curves,
                                    integers<std::size_t>(curve_of, "curve_of"), numbers(scale, "scale")};
                 trusses.rate_sensitivity = rate_sensitivity;
                 trusses.indentation_length = indentation_length;
                 trusses.wheel_of = integers<int>(wheel_of, "wheel_of");
                 trusses.along_of = integers<int>(along_of, "along_of");
                 return TrussMesh(trusses, discs(wheels));
             }),
             py::kw_only(), py::arg("nodes"), py::arg("anchors"), py::arg("curves"), py::arg("curve_of"),
             py::arg("scale"), py::arg("wheels"), py::arg("rate_sensitivity"), py::arg("indentation_length"),
             py::arg("wheel_of"), py::arg("along_of"),
             "nodes, anchors: shape (n, 3), m. curves: laws of the trusses, of which truss i has number "
             "curve_of[i] times scale[i].\n"
             "wheels: shape (w, 4), centre and radius, m. rate_sensitivity: s/m.\n"
             "indentation_length: how far an indentation reaches beyond its post, m; 0: no indentation.\n"
             "wheel_of: number of the wheel whose tread the node is on, -1 for the skin; empty: all skin.\n"
             "along_of: number of the node of the skin whose second truss this is, -1 for others; empty: "
             "none.");
    py::class_<Unit>(
        m, "Unit",
        "A rigid body with its crushable skin and wheels; body axes r, s, t, origin at the mass centre.")
        .def(
            py::init([](double mass, const InputArray& inertia, const TrussMesh& trusses,
                        const InputArray& origin, const InputArray& wheels, const InputArray& breakaway,
                        const InputArray& suspension, const InputArray& tires, double mass_center_height,
                        const InputArray& offset, const InputArray& core) {
                if (core.ndim() != 2 || core.shape(1) != 6) refuse("core shape", "(k, 6)", shape_text(core));
                std::vector<Box> boxes;
                boxes.reserve(static_cast<std::size_t>(core.shape(0)));
                for (py::ssize_t i = 0; i < core.shape(0); ++i)
                    boxes.push_back({{core.at(i, 0), core.at(i, 1), core.at(i, 2)},
                                     {core.at(i, 3), core.at(i, 4), core.at(i, 5)}});
                const RigidBody body(mass, matrix(inertia, "inertia"));
                std::vector<Wheel> discs_of_wheels = discs(wheels);
                require_row_for_each(discs_of_wheels, breakaway, 2, "breakaway");
                require_row_for_each(discs_of_wheels, suspension, 5, "suspension");
                require_row_for_each(discs_of_wheels, tires, 4, "tires");
                for (py::ssize_t i = 0; i < breakaway.shape(0); ++i) {
                    Wheel& wheel = discs_of_wheels[static_cast<std::size_t>(i)];
                    wheel.breakaway = breakaway.at(i, 0);
                    wheel.travel = breakaway.at(i, 1);
                    wheel.suspension = {suspension.at(i, 0), suspension.at(i, 1), suspension.at(i, 2),
                                        suspension.at(i, 3), suspension.at(i, 4)};
                    wheel.steering_time = tires.at(i, 0);
                    wheel.tread_radius = tires.at(i, 1);
                    wheel.camber_ratio = tires.at(i, 2);
                    wheel.rolling_resistance = tires.at(i, 3);
                }
                return Unit(body, trusses.moved(vector(origin, "origin")), std::move(discs_of_wheels),
                            mass_center_height, vector(offset, "offset"), std::move(boxes));
            }),
            py::kw_only(), py::arg("mass"), py::arg("inertia"), py::arg("trusses"), py::arg("origin"),
            py::arg("wheels"), py::arg("breakaway"), py::arg("suspension"), py::arg("tires"),
            py::arg("mass_center_height"), py::arg("offset"), py::arg("core"),
            "mass: kg. inertia: shape (3, 3), kg m^2. wheels: shape (w, 4), centre and radius, m.\n"
            "breakaway: shape (w, 2), load at which each wheel gives way, N, and how far it is then pushed "
            "up, m.\n"
            "suspension: shape (w, 5), stiffness, N/m (0: fixed to the body), damping, N s/m, compression at "
            "rest, m, travel from there to the bump stop, m, stiffness against roll over that of springs at "
            "the wheels.\n"
            "tires: shape (w, 4), time in which a wheel with free steering follows its direction of travel, "
            "s "
            "(inf: it does not steer), radius of the tread's cross-section, m, slip angle per tilt, rolling "
            "resistance per load.\n"
            "origin: shape (3,), m, of the body axes in those of the trusses; copies share what does not "
            "move.\n"
            "mass_center_height: m above the ground. offset: shape (3,), m, of the mass centre from the "
            "vehicle's reference point along the ground.\n"
            "core: shape (k, 6), middles and half edges of the boxes that the rigid body fills, body axes, "
            "m.")
        .def_property_readonly(
            "n_trusses", [](const Unit& unit) { return unit.trusses.count; },
            "number of trusses, and so of nodes of the skin and of tyres")
        .def_property_readonly(
            "input_index",
            [](const Unit& unit) {
                return std::vector<std::size_t>(unit.trusses.input_index.begin(),
                                                unit.trusses.input_index.end());
            },
            "The caller's number of each truss in the order of the state's columns.");
    py::enum_<JointKind>(m, "JointKind", "What a joint between two units holds.")
        .value("fifth_wheel", JointKind::fifth_wheel, "a point of both, and the roll beyond its limit")
        .value("welded", JointKind::welded, "a point of both and the whole orientation")
        .value("sliding", JointKind::sliding,
               "as welded, but the trailing unit slides lengthwise beyond a force");
    py::class_<Joint>(m, "Joint", "Two units joined at a point. Immutable.")
        .def(py::init([](JointKind kind, std::size_t leading, std::size_t trailing,
                         const InputArray& place_on_leading, const InputArray& place_on_trailing,
                         double roll_limit, const InputArray& slide) {
                 return Joint{kind,
                              leading,
                              trailing,
                              vector(place_on_leading, "place_on_leading"),
                              vector(place_on_trailing, "place_on_trailing"),
                              roll_limit,
                              slide_knots(slide)};
             }),
             py::kw_only(), py::arg("kind"), py::arg("leading"), py::arg("trailing"),
             py::arg("place_on_leading"), py::arg("place_on_trailing"), py::arg("roll_limit"),
             py::arg("slide"),
             "leading, trailing: numbers of the units; places (3,) m, body axes of each; roll_limit rad; "
             "slide (n, 2): force (N) that a sliding joint holds against slip (m), rows of (slip, force).");
    py::class_<Vehicle, std::shared_ptr<Vehicle>>(m, "Vehicle",
                                                  "One or more units and the joints between them. Immutable.")
        .def(py::init([](std::vector<Unit> units, std::vector<Joint> joints, double cornering_stiffness,
                         double edge_flank_factor) {
                 auto vehicle = std::make_shared<Vehicle>(joined(std::move(units), std::move(joints)));
                 vehicle->cornering_stiffness = cornering_stiffness;
                 vehicle->edge_flank_factor = edge_flank_factor;
                 return vehicle;
             }),
             py::arg("units"), py::arg("joints"), py::kw_only(), py::arg("cornering_stiffness"),
             py::arg("edge_flank_factor"),
             "cornering_stiffness (1/rad), edge_flank_factor: of runs whose settings ask for none.")
        .def_property_readonly(
            "stands_on_wheels",
            [](const Vehicle& vehicle) {
                std::vector<bool> result;
                result.reserve(vehicle.units.size());
                for (const Unit& unit : vehicle.units)
                    result.push_back(stands_on_wheels(unit));
                return result;
            },
            "Of each unit: has it wheels, with all of its skin above the ground at rest? Else its skin does "
            "not "
            "meet the ground.")
        .def(
            "springback",
            [](const Vehicle& vehicle, std::size_t unit) {
                const TrussMesh& mesh = vehicle.units.at(unit).trusses;
                return in_input_order(mesh, [&](std::size_t b, std::size_t i) {
                    return mesh.springback.empty() ? 0.0 : mesh.springback[b][i];
                });
            },
            py::arg("unit"), "(n,) m: what each node of a unit comes back by without force");
}

}  // namespace birm3d::bindings
