#include "control/balance_opening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

// Part of the energy at disposal by which a step may open the balance at the default tolerance. Large: hundreds of such steps open
// it by more than a thousandth. Small: more steps are rejected.
constexpr double greatest_opening = 5e-6;

// A shorter step has to open the balance by less than this part of what the longer one did. What no shorter step closes is
// let through.
constexpr double closes = 0.75;

}  // namespace

// Ends of segments without pins plough through the skin: forces rise and fall from node to node, and smooth estimates of their
// error do not see it.
bool opens_balance(const Scene& scene, const State& from, const Trial& tried, double& opening) {
    if (!scene.slides() || scene.barrier->free_standing->joint == SegmentJoint::pinned) return false;
    if (!from.balances.begun || !(fastest_moving_element(scene, tried.state) > 0.0)) return false;
    const double now = std::abs(tried.state.energies.total() - from.energies.total());
    const double before = std::exchange(opening, now);
    const double looser = std::max(1.0, scene.settings.tolerance / Settings{}.tolerance);
    return now < closes * before && now > greatest_opening * looser * from.balances.at_disposal;
}

}  // namespace birm3d
