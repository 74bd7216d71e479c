#include "birm3d/record/extremes.hpp"

#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <tuple>

#include "register.hpp"

namespace birm3d::bindings {

namespace py = pybind11;

namespace {

// One call instead of one for each.
py::typing::Dict<py::str, py::object> groups_of(const Extremes& found) {
    py::typing::Dict<py::str, py::object> groups;
    const auto add = [&groups](const char* name, const auto& group) {
        if (group) groups[name] = *group;
    };
    add("normal_force", found.normal_force), add("motion", found.motion);
    add("attitude", found.attitude), add("energy", found.energy);
    add("filtered_force", found.filtered_force), add("element_loads", found.element_loads);
    return groups;
}

}  // namespace

void register_extremes(py::module_& m) {
    py::class_<ExtremeGroups>(m, "ExtremeGroups", "Which groups of extremes are wanted.")
        .def(py::init([](bool normal_force, bool motion, bool attitude, bool energy, bool filtered_force,
                         bool filtered_deceleration, bool penetration, bool wheel_climb, bool element_loads,
                         bool momentum, bool joint, bool moving_elements) {
                 return ExtremeGroups{.normal_force = normal_force,
                                      .motion = motion,
                                      .attitude = attitude,
                                      .energy = energy,
                                      .filtered_force = filtered_force,
                                      .filtered_deceleration = filtered_deceleration,
                                      .penetration = penetration,
                                      .wheel_climb = wheel_climb,
                                      .element_loads = element_loads,
                                      .momentum = momentum,
                                      .joint = joint,
                                      .moving_elements = moving_elements};
             }),
             py::kw_only(), py::arg("normal_force") = false, py::arg("motion") = false,
             py::arg("attitude") = false, py::arg("energy") = false, py::arg("filtered_force") = false,
             py::arg("filtered_deceleration") = false, py::arg("penetration") = false,
             py::arg("wheel_climb") = false, py::arg("element_loads") = false, py::arg("momentum") = false,
             py::arg("joint") = false, py::arg("segments") = false);
    py::class_<Extremes::NormalForce>(
        m, "ExtremeNormalForce",
        "Force of the barrier on all units along its normal, as means over the output intervals.")
        .def_readonly("peak", &Extremes::NormalForce::peak, "N, the greatest mean of any interval")
        .def_readonly("last", &Extremes::NormalForce::last, "N, the mean of the last interval");
    py::class_<Extremes::Motion>(m, "ExtremeMotion", "Greatest speeds and displacements of unit 0.")
        .def_property_readonly(
            "towards",
            [](const Extremes::Motion& self) {
                return std::tuple(self.towards.x(), self.towards.y(), self.towards.z());
            },
            "unit vector towards the barrier, world; of a path along its line that of the path")
        .def_readonly("approach_speed", &Extremes::Motion::approach_speed,
                      "m/s, speed towards the barrier at the start")
        .def_readonly("reversal_time", &Extremes::Motion::reversal_time,
                      "s, when that speed has come down to zero; None where it never has")
        .def_readonly("travel", &Extremes::Motion::travel, "m, greatest displacement towards the barrier")
        .def_readonly("velocity_change", &Extremes::Motion::velocity_change,
                      "m/s, greatest magnitude of the change since the start")
        .def_readonly("deceleration", &Extremes::Motion::deceleration,
                      "m/s^2, greatest mean of any interval along r, body axes");
    py::class_<Extremes::Attitude>(
        m, "ExtremeAttitude", "Greatest magnitudes of the angles of unit 0, counted on beyond half a turn.")
        .def_readonly("roll", &Extremes::Attitude::roll, "rad, greatest magnitude of the roll")
        .def_readonly("pitch", &Extremes::Attitude::pitch, "rad, greatest magnitude of the pitch")
        .def_readonly("yaw", &Extremes::Attitude::yaw,
                      "rad, greatest magnitude of the yaw since the start, until separation");
    py::class_<Extremes::Energy>(m, "ExtremeEnergy", "How well the energy balance of the run closes.")
        .def_readonly("start", &Extremes::Energy::start, "J, kinetic energy at the start")
        .def_readonly("residual", &Extremes::Energy::residual,
                      "J, greatest departure of the sum of all energies from that at the start");
    py::class_<Extremes::FilteredForce>(m, "ExtremeFilteredForce",
                                        "Force of the barrier on all units along its normal, filtered.")
        .def_readonly("cfc60", &Extremes::FilteredForce::cfc60,
                      "N, greatest with CFC 60; None where the rows are too far apart for the filter")
        .def_readonly("mean_50ms", &Extremes::FilteredForce::mean_50ms, "N, greatest mean over 50 ms");
    py::class_<Extremes::ElementLoads>(
        m, "ExtremeElementLoads",
        "Greatest loads on any element of the barrier; moments about its foot, of walls about their lines.")
        .def_readonly("force", &Extremes::ElementLoads::force, "N, greatest force")
        .def_readonly("force_50ms", &Extremes::ElementLoads::force_50ms, "N, greatest mean over 50 ms")
        .def_readonly("moment", &Extremes::ElementLoads::moment, "N m, greatest moment")
        .def_readonly("moment_50ms", &Extremes::ElementLoads::moment_50ms, "N m, greatest mean over 50 ms");
    py::class_<Extremes::MovingElements>(m, "ExtremeSegments", "How far the elements of a barrier move.")
        .def_readonly("deflection", &Extremes::MovingElements::deflection,
                      "m, of the furthest corner of any base, square to the line, away from the traffic")
        .def_readonly("residual_deflection", &Extremes::MovingElements::residual_deflection,
                      "m, the same at the end")
        .def_readonly("tilt", &Extremes::MovingElements::tilt, "rad, greatest tilt of any post that yields")
        .def_readonly("residual_tilt", &Extremes::MovingElements::residual_tilt, "rad, the same at the end")
        .def_readonly("overturning", &Extremes::MovingElements::overturning,
                      "m/s^2, overturning moment over mass and half the base, 50-ms means");
    py::class_<Extremes::JointLoads>(m, "ExtremeJointLoads", "Articulation and force of the first joint.")
        .def_readonly("angle", &Extremes::JointLoads::angle, "rad, greatest magnitude of the articulation")
        .def_readonly("slip", &Extremes::JointLoads::slip, "m, greatest slip of a sliding joint")
        .def_readonly("force_50ms", &Extremes::JointLoads::force_50ms,
                      "N, greatest mean over 50 ms of the force on the leading unit");
    py::class_<Extremes> extremes(
        m, "Extremes", "Extremes of a history over its output instants; a group that was not wanted raises.");
    extremes.def_readonly("rows", &Extremes::rows, "number of output instants")
        .def_readonly("end_time", &Extremes::end_time, "s, the last output instant")
        .def_property_readonly("groups", &groups_of, "by name, the groups of several numbers that were found")
        .def_property_readonly(
            "normal_force", [](const Extremes& found) { return found.normal_force.value(); },
            "N, of the barrier on all units along its normal")
        .def_property_readonly(
            "motion", [](const Extremes& found) { return found.motion.value(); },
            "speeds and displacements of unit 0 towards the barrier (SI)")
        .def_property_readonly(
            "attitude", [](const Extremes& found) { return found.attitude.value(); },
            "rad, greatest roll, pitch and yaw of unit 0")
        .def_property_readonly(
            "energy", [](const Extremes& found) { return found.energy.value(); },
            "J, kinetic energy at the start and the residual of the balance")
        .def_property_readonly(
            "filtered_force", [](const Extremes& found) { return found.filtered_force.value(); },
            "N, of the barrier on all units along its normal, filtered")
        .def_readonly("filtered_deceleration", &Extremes::filtered_deceleration,
                      "m/s^2, along r, CFC 60; None where the rows are too far apart for the filter")
        .def_property_readonly(
            "penetration", [](const Extremes& found) { return found.penetration.value(); },
            "m, greatest distance of an anchor past the barrier's line, at least 0")
        .def_property_readonly(
            "wheel_climb", [](const Extremes& found) { return found.wheel_climb.value(); },
            "m, greatest height of any wheel's lowest point, at least 0")
        .def_property_readonly(
            "element_loads", [](const Extremes& found) { return found.element_loads.value(); },
            "N and N m, greatest loads on any element of the barrier")
        .def_property_readonly(
            "momentum_residual", [](const Extremes& found) { return found.momentum_residual.value(); },
            "max |m a - sum of forces| / max |force|")
        .def_property_readonly(
            "joint", [](const Extremes& found) { return found.joint.value(); },
            "rad and N, articulation and force of the first joint")
        .def_property_readonly(
            "segments", [](const Extremes& found) { return found.moving_elements.value(); },
            "m and m/s^2, movement of free-standing segments or of posts that yield");
}

}  // namespace birm3d::bindings
