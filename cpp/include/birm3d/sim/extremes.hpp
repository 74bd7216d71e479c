// Extremes of a history over its output instants, from which scalars are made: in one place, so that a run of which no
// history is kept has the same scalars, bit for bit, as one with it.
#pragma once

#include <cstddef>
#include <optional>

#include "birm3d/sim/event.hpp"
#include "birm3d/sim/recorder.hpp"

namespace birm3d {

// Which groups of extremes are wanted.
struct ExtremeGroups {
    bool normal_force = true, motion = true, attitude = true, energy = true;

    Channels channels() const {
        return {
            .energies = energy, .normal_force = normal_force, .motion = motion || attitude, .forces = false};
    }
};

// Of unit 0 where nothing else is said; groups are absent where they are not wanted.
struct Extremes {
    std::size_t rows = 0;   // output instants
    double end_time = 0.0;  // the last of them (s)

    // Of the barrier on all units, component against History::towards, interval means.
    struct NormalForce {
        double peak;  // N
        double last;  // in the last interval (N)
    };
    struct Motion {
        Vec3 towards;                     // History::towards
        double approach_speed;            // along History::towards, at the start (m/s)
        std::optional<double> turn_time;  // when that speed has come down to zero (s)
        double way;                       // greatest along History::towards (m)
        double velocity_change;           // greatest from the start, until separation (m/s)
        double deceleration;              // greatest along r, interval means (m/s^2)
    };
    // Greatest magnitudes, counted on beyond half a turn; yaw from the start, until separation (rad).
    struct Attitude {
        double roll, pitch, yaw;
    };
    struct Energy {
        double start;     // kinetic (J)
        double residual;  // greatest departure of the sum of all terms from that at the start (J)
    };
    std::optional<NormalForce> normal_force;
    std::optional<Motion> motion;
    std::optional<Attitude> attitude;
    std::optional<Energy> energy;
};

// `history` has all its columns, or those of wanted.channels(). The change of velocity and the yaw count until the vehicle
// separated from the barrier, if it did.
Extremes extremes_of(const History& history, const ExtremeGroups& wanted, const Event& event);

}  // namespace birm3d
