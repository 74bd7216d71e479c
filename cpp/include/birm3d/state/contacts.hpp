// State of a unit's contacts that the next step needs, beside its trusses.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "birm3d/base/types.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/state/contact_load.hpp"

namespace birm3d {

// Sums over all that a unit's skin touches, world axes.
struct SkinForces {
    Wrench contact;             // on the vehicle, without friction (N, N m)
    Wrench friction;            // N, N m
    double normal_force = 0.0;  // sum over nodes of the force along each surface normal (N)
    double work = 0.0;          // done on the trusses since the last instant, trapezoid rule (J)
    double stored = 0.0;        // elastic energy that unloading would return (J), blocks seen only
    double stiffness = 0.0;  // sum of unloading slopes of pushing nodes times inverse effective mass (1/s^2)
    // Derivative of friction with respect to the unit's motion, at the motion for which friction was found
    // (kernels/friction.hpp).
    Mat6 resistance = Mat6::Zero();
    Twist friction_motion;
};

// Which panels of a unit an obstacle indents (src/kernels/indentation.hpp), bit by bit. A panel that it has entered from
// the side, and not at a rounded corner, is `passed`: the obstacle does not indent it before it has been in front of it again.
struct IndentedPanels {
    std::size_t obstacle = 0;
    std::uint8_t panels = 0, passed = 0;
    std::array<double, birm3d::panels> behind{};  // how far each indentation stays behind the post (m)
};

// What the obstacle indents in the list; nothing where that does not have it.
inline IndentedPanels panels_by(const std::vector<IndentedPanels>& list, std::size_t obstacle) {
    const auto known = std::find_if(list.begin(), list.end(), [obstacle](const IndentedPanels& indented) {
        return indented.obstacle == obstacle;
    });
    return known != list.end() ? *known : IndentedPanels{obstacle};
}

}  // namespace birm3d
