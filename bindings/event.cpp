#include "birm3d/record/event.hpp"

#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <string>
#include <tuple>

#include "arrays.hpp"
#include "register.hpp"

namespace birm3d::bindings {

namespace {

// Text rather than an enumeration: it goes into files and tables as it is.
std::string verdict(const Event& event) {
    constexpr std::array names = {"undecided", "stopped",    "redirected",
                                  "passed",    "overridden", "rolled_over"};
    static_assert(names.size() == static_cast<std::size_t>(Verdict::rolled_over) + 1);
    return names.at(static_cast<std::size_t>(event.outcome()));
}

std::string manner(const Event& event) {
    constexpr std::array names = {
        "no_barrier", "moving",  "rests_untouched", "rests",        "rebounds", "leaves", "slides_to_end",
        "slides_on",  "between", "beside",          "rests_beyond", "over",     "slow"};
    static_assert(names.size() == static_cast<std::size_t>(Manner::slow) + 1);
    return names.at(static_cast<std::size_t>(event.manner));
}

}  // namespace

void register_event(py::module_& m) {
    py::class_<Event>(m, "Event", "What became of the vehicle at the barrier. Immutable.")
        .def_property_readonly("outcome", &verdict,
                               "undecided, stopped, redirected, passed, overridden or rolled_over")
        .def_property_readonly("manner", &manner, "how it came to that")
        .def_property_readonly("rolled_over", &Event::rolled_over,
                               "did a vehicle that stood upright ever have an up axis beyond the horizontal?")
        .def_readonly("touching", &Event::touching, "does the vehicle touch the barrier now?")
        .def_property_readonly(
            "time_of_separation",
            [](const Event& event) {
                return event.separated ? std::optional(event.released_at) : std::nullopt;
            },
            "s: the last loss of contact before the vehicle had left for good; None where it had not")
        .def_property_readonly(
            "exit_velocity",
            [](const Event& event) {
                const Vec3& v = event.released_velocity;
                return event.separated ? std::optional(std::tuple(v.x(), v.y(), v.z())) : std::nullopt;
            },
            "m/s, velocity of unit 0 at the separation, world; None where there was none")
        .def_property_readonly(
            "exit_deflection",
            [](const Event& event) {
                return event.separated ? std::optional(event.deflection) : std::nullopt;
            },
            "m, greatest deflection of all trusses when it had left, less their springback")
        .def_readonly("later_contacts", &Event::later_contacts,
                      "contacts with the barrier that began after it had left");
}

}  // namespace birm3d::bindings
