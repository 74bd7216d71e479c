#include "birm3d/ensemble/runner.hpp"

#include <pybind11/stl.h>

#include <atomic>
#include <exception>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "register.hpp"

namespace birm3d::bindings {

namespace {

// Ends runs from another thread.
struct Stop {
    std::atomic<bool> set = false;
};
struct Stopped : std::exception {};

// What a run came to, or what went wrong with it.
struct Run {
    RunSummary outcome;
    std::exception_ptr error;

    const RunSummary& checked() const {
        if (error) std::rethrow_exception(error);
        return outcome;
    }
};

using Job = std::pair<const Scene*, Approach>;

// Those that were run before `stop`.
std::vector<Run> run_all(Runner& runner, const std::vector<Job>& jobs, const ExtremeGroups& wanted,
                         const Stop& stop) {
    const auto poll = [&stop] {
        if (stop.set) throw Stopped();
    };
    std::vector<Run> runs;
    runs.reserve(jobs.size());
    const Scene* last = nullptr;
    for (const auto& [scene, approach] : jobs) {
        Run run;
        try {
            poll();
            if (scene != std::exchange(last, nullptr)) runner.set_scene(*scene);
            last = scene;
            run.outcome = runner.run(approach, wanted, poll);
        } catch (const Stopped&) {
            break;
        } catch (...) {
            run.error = std::current_exception();
        }
        runs.push_back(std::move(run));
    }
    return runs;
}

}  // namespace

void register_runner(py::module_& m) {
    py::class_<Stop>(m, "Stop", "Ends runs from another thread.")
        .def(py::init<>())
        .def(
            "set", [](Stop& stop) { stop.set = true; }, "Ask all runs that look at this stop to end.")
        .def("is_set", [](const Stop& stop) { return stop.set.load(); }, "Was `set` called?");

    py::class_<RunSummary>(m, "Outcome", "What a run came to (SI).")
        .def_readonly("end_reason", &RunSummary::end_reason, "why the run ended")
        .def_readonly("state_hash", &RunSummary::state_hash, "hash of all bits of the state at the end")
        .def_readonly("statistics", &RunSummary::statistics, "counts and lengths of the steps")
        .def_readonly("balances", &RunSummary::balances,
                      "J and N s, departures of the energy and momentum balances")
        .def_readonly("run_time", &RunSummary::run_time, "s, wall time of the stepping")
        .def_property_readonly(
            "final_velocity",
            [](const RunSummary& outcome) {
                const Vec3& v = outcome.final_velocity;
                return std::tuple(v.x(), v.y(), v.z());
            },
            "m/s, velocity of unit 0 at the end, world")
        .def_readonly("deflection", &RunSummary::deflection, "m, greatest deflection of the skin at the end")
        .def_readonly("peak_deflection", &RunSummary::peak_deflection,
                      "m, greatest deflection of the skin during the run")
        .def_readonly("event", &RunSummary::event, "what became of the vehicle at the barrier")
        .def_readonly("extremes", &RunSummary::extremes,
                      "the groups of extremes that were wanted, over the output instants");

    py::class_<Run>(m, "Run", "A run that is over.")
        .def("outcome", &Run::checked, py::return_value_policy::reference_internal,
             "What it came to; raises what went wrong.");

    py::class_<Runner>(m, "Runner",
                       "Runs one after the other in the same memory, of which no histories are kept.")
        .def(py::init<>())
        .def("run", &run_all, py::arg("jobs"), py::arg("wanted"), py::arg("stop"),
             py::call_guard<py::gil_scoped_release>(),
             "Run scenes from their starts, each with an approach of its own. Returns those that\nwere run "
             "before `stop` was set.");
}

}  // namespace birm3d::bindings
