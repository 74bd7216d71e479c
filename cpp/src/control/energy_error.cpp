#include "control/energy_error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

// Greatest change of the total energy in a step, over the energy at disposal, at the default tolerance. With a greater limit,
// hundreds of steps add up to more than a thousandth. With a smaller one, more steps are rejected.
constexpr double greatest_error = 5e-6;

// A still shorter step is tried only while each reduces the change by a quarter.
constexpr double greatest_ratio = 0.75;

}  // namespace

// Ends of segments without pins cut through the skin. Forces then rise and fall from node to node, which smooth estimates of their
// error do not see.
bool has_reducible_energy_error(const Scene& scene, const State& from, const Trial& tried,
                                double& energy_error) {
    if (!scene.slides() || scene.barrier->free_standing->joint == SegmentJoint::pinned) return false;
    if (!from.balances.begun || !(fastest_moving_element(scene, tried.state) > 0.0)) return false;
    const double now = std::abs(tried.state.energies.total() - from.energies.total());
    const double before = std::exchange(energy_error, now);
    const double tolerance_ratio = std::max(1.0, scene.settings.tolerance / Settings{}.tolerance);
    return now < greatest_ratio * before &&
           now > greatest_error * tolerance_ratio * from.balances.at_disposal;
}

}  // namespace birm3d
