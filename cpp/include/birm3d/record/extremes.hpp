// Extremes of a history over its output instants, from which metrics are made. A run whose history is not kept has
// the same extremes, bit for bit.
#pragma once

#include <cstddef>
#include <optional>

#include "birm3d/record/event.hpp"
#include "birm3d/record/recorder.hpp"

namespace birm3d {

// Which groups of extremes are wanted.
struct ExtremeGroups {
    bool normal_force = true, motion = true, attitude = true, energy = true;
    bool filtered_force = true, filtered_deceleration = true;
    bool penetration = true, wheel_climb = true, element_loads = true, momentum = true, joint = true,
         segments = true;

    Channels channels() const {
        return {.energies = false,
                .energy_residual = energy,
                .normal_force = normal_force || filtered_force,
                .motion = motion || attitude || filtered_deceleration || penetration || wheel_climb ||
                          momentum || joint,
                .angular_velocity = false,
                .forces = false,
                .momentum = momentum,
                .contact_forces = false,
                .elements = element_loads || segments,
                .joints = joint,
                .segments = segments};
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
        Vec3 towards;                         // History::towards
        double approach_speed;                // along History::towards, at the start (m/s)
        std::optional<double> reversal_time;  // when that speed has come down to zero (s)
        double travel;                        // greatest along History::towards (m)
        double velocity_change;               // greatest from the start, until separation (m/s)
        double deceleration;                  // greatest along r, interval means (m/s^2)
    };
    // Greatest magnitudes, counted on beyond half a turn; yaw from the start, until separation (rad).
    struct Attitude {
        double roll, pitch, yaw;
    };
    struct Energy {
        double start;     // kinetic (J)
        double residual;  // greatest departure of the sum of all terms from that at the start (J)
    };
    // Of the same component (N).
    struct FilteredForce {
        std::optional<double> cfc60;  // absent where the rows are too far apart for the filter
        double mean_50ms;             // greatest mean over 50 ms
    };
    // Greatest of all elements of the barrier; moments about their feet, of walls about their lines.
    struct ElementLoads {
        double force = 0.0, force_50ms = 0.0;    // N
        double moment = 0.0, moment_50ms = 0.0;  // N m
    };
    // Of a free-standing barrier.
    struct Segments {
        // How far the furthest corner of any base moved square to the line, away from the traffic (m).
        double deflection = 0.0, residual_deflection = 0.0;
        // Greatest of (|M| + F_z b) / (m b) in means over 50 ms (m/s^2). b is half the base and F_z the vertical
        // force on the segment. M is the moment on it about its long axis, less that of its own inertia.
        double overturning = 0.0;
    };
    struct JointLoads {
        double angle;              // greatest magnitude of the articulation (rad)
        double force, force_50ms;  // on the leading unit; of its mean over 50 ms (N)
    };
    std::optional<NormalForce> normal_force;
    std::optional<Motion> motion;
    std::optional<Attitude> attitude;
    std::optional<Energy> energy;
    std::optional<FilteredForce> filtered_force;
    std::optional<double> filtered_deceleration;  // along r, CFC 60 (m/s^2); also absent as cfc60 is
    std::optional<double>
        penetration;  // greatest distance of an anchor of any unit past the barrier's line (m)
    std::optional<double> wheel_climb;  // greatest height of any wheel's lowest point (m)
    std::optional<ElementLoads> element_loads;
    std::optional<double> momentum_residual;  // History::momentum_residual
    std::optional<JointLoads> joint;          // of the first joint
    std::optional<Segments> segments;
};

// `history` has all its columns, or those of wanted.channels(). Groups of a barrier or of a joint that is not there are
// absent. The change of velocity and the yaw count until the vehicle separated from the barrier, if it did.
Extremes extremes_of(const History& history, const Vehicle& vehicle, const Barrier* barrier,
                     const ExtremeGroups& wanted, const Event& event);

// Parts of the above.
Extremes::Motion greatest_motion(const History& history, const Event& event);
Extremes::Attitude greatest_attitude(const History& history, const Event& event);
Extremes::JointLoads greatest_joint_loads(const History& history);
double greatest_penetration(const History& history, const Vehicle& vehicle, const Barrier& barrier);
double greatest_wheel_climb(const History& history, const Vehicle& vehicle);
Extremes::ElementLoads greatest_element_loads(const History& history, const Barrier& barrier);
Extremes::Segments greatest_movement(const History& history, const Barrier& barrier);

}  // namespace birm3d
