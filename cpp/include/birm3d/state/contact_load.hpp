// The load between one obstacle and the skin of one unit, and its history over the last steps.
#pragma once

#include <cstddef>

#include "birm3d/base/types.hpp"

namespace birm3d {

// World axes.
struct Load {
    Wrench wrench;                        // on the unit, about its mass centre (N, N m)
    Vec3 reaction_torque = Vec3::Zero();  // on the obstacle, about its own origin (N m)
    double normal_force = 0.0;            // N

    Load& operator+=(const Load& o) {
        wrench += o.wrench;
        reaction_torque += o.reaction_torque;
        normal_force += o.normal_force;
        return *this;
    }
};

// On the obstacle, about its own origin.
inline Wrench reaction_of(const Load& load) {
    return {-load.wrench.force, load.reaction_torque};
}

inline Load scaled(const Load& load, double factor) {
    return {scaled(load.wrench, factor), factor * load.reaction_torque, factor * load.normal_force};
}

inline Load difference(const Load& a, const Load& b) {
    return {difference(a.wrench, b.wrench), a.reaction_torque - b.reaction_torque,
            a.normal_force - b.normal_force};
}

// The load over the last steps in Newton's divided differences, as the multistep scheme needs it.
struct LoadHistory {
    Load now;
    Load rate;                   // first divided difference, over the last step (per s)
    Load second_difference;      // second divided difference, over the last two steps (per s^2)
    double step = 0.0;           // length of the last step, zero where no rate is known (s)
    double previous_step = 0.0;  // length of the one before (s)
    double time_since = 0.0;     // since the last difference was taken: steps too short to be informative (s)
    bool is_smooth = false;      // did the second difference persist through the last step?
};

// What the scheme adds to the half kicks of the trapezoid rule (step/load_history.hpp), as impulses (N s, N m s).
struct HigherOrder {
    Load predictor;  // added before the drift, subtracted after it
    Load corrector;  // of the whole step, added after the drift
};

// Contact of a unit's skin with one obstacle.
struct ContactLoad {
    std::size_t obstacle = 0;   // index in Scene::obstacles
    Wrench contact, friction;   // on the unit, about its mass centre, world axes (N, N m)
    double normal_force = 0.0;  // N
    LoadHistory history;        // of contact and friction together
    HigherOrder higher_order;   // of the step that led here
};

}  // namespace birm3d
