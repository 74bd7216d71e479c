#include <pybind11/stl.h>

#include <memory>

#include "arrays.hpp"
#include "birm3d/base/rotation.hpp"
#include "birm3d/record/extremes.hpp"
#include "register.hpp"

namespace birm3d::bindings {

namespace {

template <class Class, class T>
void add_view(py::class_<Class>& cls, const char* name, T Class::* member, const char* doc) {
    cls.def_property_readonly(
        name, [member](const py::object& self) { return view(self.cast<const Class&>().*member, self); },
        doc);
}

// One column of each free-standing segment, side by side.
OutputArray of_moving_elements(const History& history, Column MovingElementHistory::* column) {
    const auto rows = static_cast<py::ssize_t>(history.time.size());
    OutputArray result({rows, static_cast<py::ssize_t>(history.moving_elements.size())});
    auto at = result.mutable_unchecked<2>();
    for (py::ssize_t i = 0; i < at.shape(1); ++i)
        for (py::ssize_t row = 0; row < rows; ++row)
            at(row, i) =
                (history.moving_elements[static_cast<std::size_t>(i)].*column)[static_cast<std::size_t>(row)];
    return read_only(std::move(result));
}

// The same of vectors along the ground.
OutputArray of_moving_elements(const History& history, std::vector<Vec3> MovingElementHistory::* column) {
    const auto rows = static_cast<py::ssize_t>(history.time.size());
    OutputArray result({rows, static_cast<py::ssize_t>(history.moving_elements.size()), py::ssize_t{2}});
    auto at = result.mutable_unchecked<3>();
    for (py::ssize_t i = 0; i < at.shape(1); ++i)
        for (py::ssize_t row = 0; row < rows; ++row) {
            const Vec3& v =
                (history.moving_elements[static_cast<std::size_t>(i)].*column)[static_cast<std::size_t>(row)];
            at(row, i, 0) = v.x(), at(row, i, 1) = v.y();
        }
    return read_only(std::move(result));
}

// Axes of posts that yield; no columns where there are none.
OutputArray post_axes(const History& history) {
    const auto rows = static_cast<py::ssize_t>(history.time.size());
    const bool yields = !history.moving_elements.empty() && !history.moving_elements.front().axis.empty();
    const auto posts = yields ? static_cast<py::ssize_t>(history.moving_elements.size()) : py::ssize_t{0};
    OutputArray result({rows, posts, py::ssize_t{3}});
    auto at = result.mutable_unchecked<3>();
    for (py::ssize_t i = 0; i < posts; ++i)
        for (py::ssize_t row = 0; row < rows; ++row) {
            const Vec3& axis =
                history.moving_elements[static_cast<std::size_t>(i)].axis[static_cast<std::size_t>(row)];
            for (py::ssize_t k = 0; k < 3; ++k)
                at(row, i, k) = axis[static_cast<Eigen::Index>(k)];
        }
    return read_only(std::move(result));
}

}  // namespace

void register_history(py::module_& m) {
    py::class_<UnitHistory> unit(m, "UnitHistory",
                                 "Motion of one unit and the forces on it; read-only views.");
    add_view(unit, "position", &UnitHistory::position, "(n, 3) m, mass centre, world");
    add_view(unit, "velocity", &UnitHistory::velocity, "(n, 3) m/s, velocity of the mass centre, world");
    add_view(unit, "angular_velocity", &UnitHistory::angular_velocity, "(n, 3) rad/s, body axes");
    add_view(unit, "acceleration", &UnitHistory::acceleration,
             "(n, 3) m/s^2, of the mass centre, interval means, body axes");
    add_view(unit, "barrier_force", &UnitHistory::barrier_force,
             "(n, 3) N, of the barrier on the unit, interval means, world");
    add_view(unit, "ground_force", &UnitHistory::ground_force,
             "(n, 3) N, of the ground on the skin, interval means, world");
    add_view(unit, "tire_friction_force", &UnitHistory::tire_friction_force,
             "(n, 3) N, of the ground on the tyres, along the ground, interval means, world");
    add_view(unit, "barrier_normal_force", &UnitHistory::barrier_normal_force,
             "(n,) N, component of barrier_force along the barrier's normal, interval means");
    add_view(unit, "sum_of_contact_forces", &UnitHistory::sum_of_contact_forces,
             "(n,) N, magnitudes of the nodes' normal forces on the barrier, interval means");
    unit.def_property_readonly(
        "roll_pitch_yaw",
        [](const UnitHistory& history) {
            py::array_t<double> angles(
                {static_cast<py::ssize_t>(history.orientation.size()), py::ssize_t{3}});
            auto at = angles.mutable_unchecked<2>();
            py::ssize_t row = 0;
            for (const Quat& q : history.orientation) {
                const Angles a = roll_pitch_yaw(q);
                at(row, 0) = a.roll, at(row, 1) = a.pitch, at(row, 2) = a.yaw;
                ++row;
            }
            return angles;
        },
        "(n, 3) rad, roll, pitch and yaw of the body axes");
    unit.def_property_readonly(
        "tire_reaction",
        [](const UnitHistory& history) {
            const auto rows = static_cast<py::ssize_t>(history.barrier_normal_force.size());
            py::array_t<double> reaction({rows, static_cast<py::ssize_t>(history.tire_reaction.size())});
            auto at = reaction.mutable_unchecked<2>();
            py::ssize_t wheel = 0;
            for (const Column& column : history.tire_reaction) {
                for (py::ssize_t row = 0; row < rows; ++row)
                    at(row, wheel) = column[static_cast<std::size_t>(row)];
                ++wheel;
            }
            return read_only(std::move(reaction));
        },
        "(n, wheels) N, normal force of the ground on each wheel, interval means");

    py::class_<ObstacleHistory> obstacle(m, "ObstacleHistory", "What an element of the barrier feels.");
    obstacle.def_readonly("element", &ObstacleHistory::obstacle, "place among the barrier's elements");
    add_view(obstacle, "force", &ObstacleHistory::force, "(n, 3) N, interval means, world");
    add_view(obstacle, "moment", &ObstacleHistory::moment,
             "(n, 3) N m about the element's foot, interval means, world");
    add_view(unit, "joint_force", &UnitHistory::joint_force,
             "(n, 3) N, of all joints, interval means, world");

    py::class_<JointHistory> joint(m, "JointHistory",
                                   "What a joint carries, and the angles between its units.");
    add_view(joint, "force", &JointHistory::force, "(n, 3) N on the leading unit, interval means, world");
    add_view(joint, "moment", &JointHistory::moment, "(n, 3) N m on the leading unit about the joint, world");
    add_view(joint, "slip", &JointHistory::slip,
             "(n,) m, how far the trailing unit has slid forwards on the leading one");
    joint.def_property_readonly(
        "roll_pitch_yaw",
        [](const JointHistory& history) {
            py::array_t<double> angles({static_cast<py::ssize_t>(history.angles.size()), py::ssize_t{3}});
            auto at = angles.mutable_unchecked<2>();
            py::ssize_t row = 0;
            for (const JointAngles& a : history.angles) {
                at(row, 0) = a.roll, at(row, 1) = a.pitch, at(row, 2) = a.yaw;
                ++row;
            }
            return angles;
        },
        "(n, 3) rad, of the trailing unit from the leading one");

    py::class_<History> history(m, "History", "Evenly spaced output of a run; read-only views.");
    history.def(
        "extremes",
        [](const History& self, const ExtremeGroups& wanted, const Event& event, const Vehicle& vehicle,
           const std::vector<std::shared_ptr<Barrier>>& barriers) {
            return extremes_of(self, vehicle, barriers.empty() ? nullptr : barriers.front().get(), wanted,
                               event);
        },
        py::arg("wanted"), py::arg("event"), py::arg("vehicle"), py::arg("barriers"),
        py::call_guard<py::gil_scoped_release>(),
        "Extremes of a run of this vehicle into this barrier, or into none.");
    add_view(history, "time", &History::time, "(n,) s, output instants");
    for (std::size_t i = 0; i < energy_terms.size(); ++i)
        history.def_property_readonly(
            energy_terms[i].name,
            [i](const py::object& self) { return view(self.cast<const History&>().energies[i], self); },
            (std::string("(n,) J, ") + energy_terms[i].meaning).c_str());
    history.def_property_readonly(
        "segment_position",
        [](const History& self) { return of_moving_elements(self, &MovingElementHistory::position); },
        "(n, k, 2) m, foot of the axis of each free-standing segment, world");
    history.def_property_readonly(
        "segment_velocity",
        [](const History& self) { return of_moving_elements(self, &MovingElementHistory::velocity); },
        "(n, k, 2) m/s, mass centre of each segment, world");
    history.def_property_readonly(
        "segment_yaw",
        [](const History& self) { return of_moving_elements(self, &MovingElementHistory::yaw); },
        "(n, k) rad, yaw of each segment since the start");
    history.def_property_readonly(
        "segment_yaw_rate",
        [](const History& self) { return of_moving_elements(self, &MovingElementHistory::yaw_rate); },
        "(n, k) rad/s, yaw rate of each segment");
    history.def_property_readonly(
        "post_axis", [](const History& self) { return post_axes(self); },
        "(n, k, 3) unit vectors along posts that yield, upwards, world; k = 0 where none does");
    history.def_readonly("momentum_residual", &History::momentum_residual,
                         "max |m a - sum of forces| / max |force|");
    history.def_property_readonly(
        "elements",
        [](const py::object& self) {
            py::typing::List<ObstacleHistory> list;
            for (const ObstacleHistory& element : self.cast<const History&>().obstacles)
                list.append(py::cast(element, py::return_value_policy::reference_internal, self));
            return list;
        },
        "Loads on the elements of the barrier that were touched, in their order.");
    history.def(
        "unit",
        [](const History& self, std::size_t index) -> const UnitHistory& { return self.units.at(index); },
        py::return_value_policy::reference_internal, py::arg("index"),
        "Motion of one unit of the vehicle and the forces on it.");
    history.def(
        "joint",
        [](const History& self, std::size_t index) -> const JointHistory& { return self.joints.at(index); },
        py::return_value_policy::reference_internal, py::arg("index"),
        "What one joint of the vehicle carries.");
}

}  // namespace birm3d::bindings
