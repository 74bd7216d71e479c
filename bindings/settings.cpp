#include "birm3d/model/settings.hpp"

#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/model/barrier.hpp"
#include "birm3d/model/vehicle.hpp"
#include "register.hpp"

namespace birm3d::bindings {

namespace py = pybind11;

namespace {

template <auto member>
void set(Settings& settings, const py::handle& value) {
    using Value = std::remove_reference_t<decltype(settings.*member)>;
    settings.*member = value.cast<Value>();
}

struct SettingRow {
    std::string_view name;
    void (*set)(Settings&, const py::handle&);
};

// One row for each setting: its name in Python, and the member that it sets.
constexpr std::array rows = {
    SettingRow{"time_step", &set<&Settings::time_step>},
    SettingRow{"tolerance", &set<&Settings::tolerance>},
    SettingRow{"output_interval", &set<&Settings::output_interval>},
    SettingRow{"gravity", &set<&Settings::gravity>},
    SettingRow{"ground", &set<&Settings::ground>},
    SettingRow{"mu_tire", &set<&Settings::mu_tire>},
    SettingRow{"mu_body", &set<&Settings::mu_body>},
    SettingRow{"mu_tire_barrier", &set<&Settings::mu_tire_barrier>},
    SettingRow{"braking", &set<&Settings::braking>},
    SettingRow{"cornering_stiffness", &set<&Settings::cornering_stiffness>},
    SettingRow{"restitution", &set<&Settings::restitution>},
    SettingRow{"edge_flank_factor", &set<&Settings::edge_flank_factor>},
    SettingRow{"contact_model", &set<&Settings::contact_model>},
    SettingRow{"tire_model", &set<&Settings::tire_model>},
};

using Given = py::typing::Dict<py::str, py::object>;

// Settings by name; what is not given is as in `settings`.
Settings settings_from(const Given& given, Settings settings) {
    for (const auto& [key, value] : given) {
        const auto name = key.cast<std::string>();
        const auto row =
            std::find_if(rows.begin(), rows.end(), [&](const SettingRow& r) { return r.name == name; });
        if (row == rows.end()) throw py::type_error("no setting has the name " + name);
        row->set(settings, value);
    }
    require_valid(settings);
    return settings;
}

}  // namespace

void register_settings(py::module_& m) {
    py::enum_<ContactModel>(m, "ContactModel", "Direction of a truss's force on the vehicle.")
        .value("projected", ContactModel::projected, "along the surface's normal, by projection")
        .value("along_truss", ContactModel::along_truss, "along the truss: the paper's rule");
    py::enum_<TireModel>(m, "TireModel", "Rule of the friction of tyres on the ground.")
        .value("slip", TireModel::slip, "continuous in the slip angle of each wheel: the brush model")
        .value("skid", TireModel::skid, "full unless the mass centre moves along r: the paper's rule");

    py::class_<Settings>(m, "Settings", "How a scene is computed (SI). Immutable.")
        .def(py::init([](const Given& values) { return settings_from(values, {}); }), py::arg("values"),
             "What is not among the values has the default of a car.")
        .def(py::init([](const Given& values, const Vehicle& vehicle,
                         const std::vector<std::shared_ptr<Barrier>>& barriers) {
                 const Barrier* barrier = barriers.empty() ? nullptr : barriers.front().get();
                 return settings_from(values, usual_settings(vehicle, barrier));
             }),
             py::arg("values"), py::arg("vehicle"), py::arg("barriers"),
             "What is not among the values is the vehicle's. barriers: one or none, as of a Scene.")
        .def_readonly("mu_tire_barrier", &Settings::mu_tire_barrier, "friction coefficient")
        .def_readonly("cornering_stiffness", &Settings::cornering_stiffness, "1/rad")
        .def_readonly("edge_flank_factor", &Settings::edge_flank_factor, "pure number");
    // s: so long a run goes on once its outcome is known.
    m.attr("tail_duration") = tolerance::tail_duration;
    // m/s: a slower vehicle counts as at rest.
    m.attr("coasting_speed") = tolerance::coasting_speed;
    m.attr("along_line") = tolerance::along_line;
}

}  // namespace birm3d::bindings
