#include "birm3d/simulation/simulation.hpp"

#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <algorithm>
#include <map>
#include <string>

#include "arrays.hpp"
#include "bound_simulation.hpp"
#include "input_order.hpp"
#include "register.hpp"

namespace birm3d::bindings {

namespace {

// None or one: a scene has at most one barrier.
std::shared_ptr<const Barrier> only(const std::vector<std::shared_ptr<Barrier>>& barriers) {
    if (barriers.size() > 1) refuse("barriers", "at most 1", static_cast<double>(barriers.size()));
    return barriers.empty() ? nullptr : barriers.front();
}

// A column of one unit's trusses in the caller's order.
OutputArray state_column(const Simulation& simulation, std::size_t unit,
                         BlockColumn TrussBlockState::* column) {
    const TrussMesh& mesh = simulation.scene().vehicle->units.at(unit).trusses;
    const TrussState& trusses = simulation.state().units.at(unit).trusses;
    return in_input_order(mesh, [&](std::size_t b, std::size_t i) { return (trusses.block[b].*column)[i]; });
}

// The same for the three coordinates of the nodes.
OutputArray nodes_in_input_order(Simulation& simulation, std::size_t unit) {
    const TrussMesh& mesh = simulation.scene().vehicle->units.at(unit).trusses;
    const TrussState& trusses = simulation.state().units.at(unit).trusses;
    OutputArray nodes({static_cast<py::ssize_t>(mesh.count), py::ssize_t{3}});
    auto at = nodes.mutable_unchecked<2>();
    for (std::size_t truss = 0; truss < mesh.count; ++truss) {
        const std::size_t i = mesh.slot(truss);
        const auto row = static_cast<py::ssize_t>(mesh.input_index[truss]);
        const TrussBlockState& block = trusses.block[i / block_size];
        at(row, 0) = block.x[i % block_size], at(row, 1) = block.y[i % block_size],
                at(row, 2) = block.z[i % block_size];
    }
    return read_only(std::move(nodes));
}

// Without the interpreter's lock, but for a look at signals now and then.
void run(Simulation& simulation, const std::optional<py::typing::Callable<void(double, std::size_t)>>& tick) {
    const py::gil_scoped_release release;
    simulation.run([&simulation, &tick] {
        const py::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (tick) (*tick)(simulation.state().time, simulation.state().statistics.steps);
    });
}

}  // namespace

void register_simulation(py::module_& m) {
    py::enum_<EndReason>(m, "EndReason", "Why a run ended.")
        .value("running", EndReason::running, "it has not ended")
        .value("duration", EndReason::duration, "the time that was asked for is over")
        .value("separated", EndReason::separated, "the vehicle has left the barrier for good")
        .value("stopped", EndReason::stopped, "the vehicle rests")
        .value("sliding", EndReason::sliding,
               "it slides along a straight barrier, and nothing changes any more")
        .value("longest", EndReason::longest, "the longest run is over, with an open outcome");

    py::class_<StepStatistics>(m, "StepStatistics",
                               "Counts and lengths of the steps of a run, and what they met.")
        .def_readonly("steps", &StepStatistics::steps, "accepted steps")
        .def_readonly("rejected", &StepStatistics::rejected, "steps that were tried and found too long")
        .def_readonly("node_evaluations", &StepStatistics::node_evaluations,
                      "nodes whose contact was computed, summed over all steps, those rejected too")
        .def_readonly("shortest_step", &StepStatistics::shortest_step, "s, the shortest accepted step")
        .def_readonly("longest_step", &StepStatistics::longest_step, "s, the longest accepted step")
        .def_readonly("skin_nodes", &StepStatistics::skin_nodes,
                      "nodes of the skin in blocks that anything came into in any step")
        .def_readonly("tread_nodes", &StepStatistics::tire_nodes, "the same of tyres")
        .def_readonly("near_elements", &StepStatistics::near_elements,
                      "elements of the barrier that any node was within reach of, or the rigid body met")
        .def_readonly("free_steps", &StepStatistics::free_steps,
                      "steps in which no node was within reach of anything")
        .def_readonly("free_time", &StepStatistics::free_time, "s, sum of these steps")
        .def_readonly("body_steps", &StepStatistics::body_steps,
                      "steps in which the rigid body stood against the barrier or the ground")
        .def_readonly("core_contact_force", &StepStatistics::core_contact_force,
                      "N, greatest mean over 50 ms of the barrier's force on the rigid core")
        .def_readonly("core_contact_time", &StepStatistics::core_contact_time,
                      "s, time of that greatest mean")
        .def_readonly("fastest_rise", &StepStatistics::fastest_rise,
                      "m/s, greatest upward speed of a unit's mass centre after the barrier was touched")
        .def_readonly("greatest_tilt", &StepStatistics::greatest_tilt,
                      "rad, greatest tilt of a post that yields, from the vertical")
        .def_readonly("wheels_given_way", &StepStatistics::wheels_given_way,
                      "wheels that were loaded beyond what they carry, and have given way")
        .def_readonly("wheels_on_ground", &StepStatistics::wheels_on_ground,
                      "wheels that carried load, summed over the steps")
        .def_readonly("deepest_point", &StepStatistics::deepest_point,
                      "m, greatest depth of an anchor of a bottomed-out truss inside a barrier")
        .def_readonly("greatest_overlap", &StepStatistics::greatest_overlap,
                      "m, greatest overlap of the rigid body's boxes and an element of the barrier")
        .def_readonly("greatest_overlap_time", &StepStatistics::greatest_overlap_time,
                      "s, time of that overlap")
        .def_readonly("greatest_overlap_element", &StepStatistics::greatest_overlap_element,
                      "number of the barrier's element in that overlap")
        .def_readonly("least_critical_step", &StepStatistics::least_critical_step,
                      "s, least sqrt(3)/omega of the trusses in contact");

    py::class_<Balances::Departure>(m, "Departure",
                                    "The greatest departure of a balance so far, when and where.")
        .def_readonly("size", &Balances::Departure::size, "J of energy, N s of momentum")
        .def_readonly("time", &Balances::Departure::time, "s, end of the step in which it was greatest")
        .def_property_readonly(
            "place",
            [](const Balances::Departure& d) { return std::tuple(d.place.x(), d.place.y(), d.place.z()); },
            "m, mass centre of unit 0 then, world");

    py::class_<Balances>(m, "Balances", "How far the balances of energy and momentum are from closing.")
        .def_readonly("kinetic", &Balances::kinetic, "J, kinetic energy at the start")
        .def_readonly("at_disposal", &Balances::at_disposal,
                      "J, kinetic at the start and the most that the weight has done")
        .def_readonly("energy", &Balances::energy,
                      "departure of the sum of all energies from that at the start")
        .def_readonly("momentum", &Balances::momentum,
                      "departure of a unit's change of momentum in a step from the sum of all impulses on it")
        .def_readonly("largest_momentum", &Balances::largest_momentum,
                      "N s, largest momentum of a unit, or impulse in a step")
        .def_property_readonly(
            "sizes",
            [](const Balances& balances) {
                double fall = 0.0;
                for (const Balances::Departure& departure : balances.falls)
                    fall = std::max(fall, departure.size);
                return std::tuple(balances.energy.size, balances.momentum.size, fall, balances.at_disposal,
                                  balances.largest_momentum);
            },
            "sizes of energy and momentum, the largest fall of any dissipated term (J), at_disposal, "
            "largest_momentum")
        .def_property_readonly(
            "falls",
            [](const Balances& balances) {
                std::map<std::string, Balances::Departure> by_name;
                for (std::size_t i = 0; i < energy_terms.size(); ++i)
                    if (energy_terms[i].is_loss) by_name[energy_terms[i].name] = balances.falls[i];
                return by_name;
            },
            "by name, the greatest fall of each dissipated energy below its highest value so far");

    py::class_<Approach>(m, "Approach", "How the vehicle comes (SI, rad). Immutable.")
        .def(py::init([](double speed, double angle, double offset, double standoff, double yaw,
                         double roll) { return Approach{speed, angle, offset, standoff, yaw, roll}; }),
             py::kw_only(), py::arg("speed"), py::arg("angle"), py::arg("offset"), py::arg("standoff"),
             py::arg("yaw"), py::arg("roll"));

    py::class_<Simulation::Snapshot>(m, "Snapshot",
                                     "A checkpoint: state and record. It lives in memory only.")
        .def_property_readonly(
            "time", [](const Simulation::Snapshot& s) { return s.state.time; }, "s, time of the state")
        .def("__reduce__", [](const Simulation::Snapshot&) -> py::object {
            throw py::type_error(
                "a snapshot lives in memory and is not pickled: pickle the Simulation, which keeps its "
                "state");
        });

    py::class_<Scene>(m, "Scene", "What a run is about (SI, rad): checked, but for its start. Immutable.")
        .def(py::init([](std::shared_ptr<Vehicle> vehicle,
                         const std::vector<std::shared_ptr<Barrier>>& barriers, const Approach& approach,
                         const Settings& settings, std::optional<double> duration) {
                 return Scene(std::move(vehicle), only(barriers), approach, settings, duration);
             }),
             py::kw_only(), py::arg("vehicle"), py::arg("barriers"), py::arg("approach"), py::arg("settings"),
             py::arg("duration"));

    // Reads of one number or column, and what changes the state: each has the simulation to itself.
    py::class_<BoundSimulation>(
        m, "Simulation",
        "A run of one scene (SI, rad). One user at a time: any other gets a BusyError. `with "
        "simulation:` keeps others out\nbetween several calls.")
        .def(py::init([](const Scene& scene) { return std::make_unique<BoundSimulation>(scene); }),
             py::arg("scene"))
        .def("__enter__", [](BoundSimulation& simulation) { simulation.in_block.take(); })
        .def("__exit__", [](BoundSimulation& simulation, const py::object&, const py::object&,
                            const py::object&) { simulation.in_block.release(); })
        .def("step", alone(+[](Simulation& s) { return s.step(); }), py::call_guard<py::gil_scoped_release>(),
             "One accepted step; False when the run is over.")
        .def(
            "run", alone(&run), py::arg("tick") = py::none(),
            "From the present state to the end; Ctrl-C stops it. `tick` is called now and then with the time "
            "(s) and the number of steps.")
        .def("reset", alone(+[](Simulation& s) { s.reset(); }), "Go back to the start of the scene.")
        .def("snapshot", alone(+[](Simulation& s) { return s.snapshot(); }),
             "A checkpoint of the present state and record.")
        .def("restore", alone(+[](Simulation& s, const Simulation::Snapshot& from) { s.restore(from); }),
             py::arg("snapshot"), "Go back to a snapshot of the same scene.")
        .def("history", alone(+[](Simulation& s) { return s.recorder().resample(s.scene()); }),
             py::call_guard<py::gil_scoped_release>(), "Evenly spaced output so far.")
        .def_property_readonly("state_hash", alone(+[](Simulation& s) { return s.state().hash(); }),
                               "Hash of all bits of the present state.")
        .def_property_readonly("time", alone(+[](Simulation& s) { return s.state().time; }),
                               "s, time of the present state")
        .def_property_readonly("end_reason", alone(+[](Simulation& s) { return s.end_reason(); }),
                               "Why the run ended; `running` before it does.")
        .def_property_readonly("event", alone(+[](Simulation& s) { return s.event(); }),
                               "What became of the vehicle at the barrier, so far.")
        .def_property_readonly("failed", alone(+[](Simulation& s) { return s.failed(); }),
                               "Did the last step fail half way? Then only reset and restore are of use.")
        .def_property_readonly("replays", alone(+[](Simulation& s) { return s.replays(); }),
                               "Do as many steps from the start lead to this state?")
        .def_property_readonly("touched", alone(+[](Simulation& s) { return s.state().touched; }),
                               "Has the vehicle touched the barrier so far?")
        .def_property_readonly("deepest_node", alone(+[](Simulation& s) { return s.deepest_node(); }),
                               "m: depth of the deepest shell node inside the barrier now, 0 if none is")
        .def_property_readonly("deepest_anchor", alone(+[](Simulation& s) { return s.deepest_anchor(); }),
                               "m: depth of the deepest truss anchor inside the barrier now, 0 if none is")
        .def_property_readonly("statistics", alone(+[](Simulation& s) { return s.state().statistics; }),
                               "Counts and lengths of the steps so far.")
        .def_property_readonly("balances", alone(+[](Simulation& s) { return s.state().balances; }),
                               "Departures of the energy and momentum balances so far (J, N s).")
        .def("velocity", alone(+[](Simulation& s, std::size_t unit) {
                 return copy(s.state().units.at(unit).body.velocity);
             }),
             py::arg("unit") = 0, "(3,) m/s, world, now")
        .def("pose", alone(+[](Simulation& s, std::size_t unit) {
                 const BodyState& body = s.state().units.at(unit).body;
                 return std::pair(copy(Vec3(s.scene().base + body.position)),
                                  copy(Mat3(body.orientation.toRotationMatrix())));
             }),
             py::arg("unit") = 0,
             "Now: mass centre, (3,) m, world; rotation from body axes to the world's, (3, 3)")
        .def(
            "skin_load", alone(+[](Simulation& s, std::size_t unit) {
                const SkinForces& skin = s.state().units.at(unit).skin;
                return std::tuple(copy(skin.contact.force), copy(skin.friction.force), skin.normal_force);
            }),
            py::arg("unit") = 0,
            "Now: force of all that nodes push on, without friction, (3,) N, world; friction, (3,) N; sum of "
            "the "
            "nodes' normal forces, N")
        .def("nodes", alone(&nodes_in_input_order), py::arg("unit") = 0,
             "(n, 3) m: shell nodes now, body axes")
        .def("deflection", alone(+[](Simulation& s, std::size_t unit) {
                 return state_column(s, unit, &TrussBlockState::deflection);
             }),
             py::arg("unit") = 0, "(n,) m: truss deflections now")
        .def("peak_deflection", alone(+[](Simulation& s, std::size_t unit) {
                 return state_column(s, unit, &TrussBlockState::peak_deflection);
             }),
             py::arg("unit") = 0, "(n,) m: greatest truss deflections so far")
        .def("truss_force", alone(+[](Simulation& s, std::size_t unit) {
                 return state_column(s, unit, &TrussBlockState::force);
             }),
             py::arg("unit") = 0, "(n,) N: truss forces now");
}

}  // namespace birm3d::bindings
