// Extremes of a history over its output instants, from which metrics are made. A run whose history is not kept has
// the same extremes, bit for bit.
#pragma once

#include <cstddef>
#include <optional>

#include "birm3d/record/event.hpp"
#include "birm3d/record/recorder.hpp"

namespace birm3d {

// Each flag says whether a group of extremes is wanted.
struct ExtremeGroups {
    bool normal_force = true, motion = true, attitude = true, energy = true;
    bool filtered_force = true, filtered_deceleration = true;
    bool penetration = true, wheel_climb = true, element_loads = true, momentum = true, joint = true,
         moving_elements = true;

    // The columns of the history that the wanted groups need.
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
                .elements = element_loads || moving_elements,
                .joints = joint,
                .moving_elements = moving_elements};
    }
};

// Extremes describe unit 0 where they name no other body. Groups that are not wanted are absent.
struct Extremes {
    std::size_t rows = 0;   // number of output instants
    double end_time = 0.0;  // the last output instant (s)

    // Component against History::towards of the barrier's force on all units, as means over the output intervals.
    struct NormalForce {
        double peak;  // the greatest mean of any interval (N)
        double last;  // the mean of the last interval (N)
    };
    struct Motion {
        Vec3 towards;                         // History::towards, world axes
        double approach_speed;                // speed along History::towards at the start (m/s)
        std::optional<double> reversal_time;  // time at which that speed has come down to zero (s)
        double travel;                        // greatest displacement along History::towards (m)
        double velocity_change;  // greatest magnitude of the change since the start, until separation (m/s)
        double deceleration;     // greatest mean of any interval along the body's r axis (m/s^2)
    };
    // Greatest magnitudes of the angles (rad). They are counted on beyond half a turn. Yaw is that since the start, until
    // separation.
    struct Attitude {
        double roll, pitch, yaw;
    };
    struct Energy {
        double start;     // kinetic energy at the start (J)
        double residual;  // greatest departure of the sum of all energies from their sum at the start (J)
    };
    // Filtered values of the force in NormalForce (N).
    struct FilteredForce {
        // The greatest with CFC 60. It is absent where the rows are too far apart for the filter.
        std::optional<double> cfc60;
        double mean_50ms;  // the greatest mean over 50 ms
    };
    // Greatest magnitudes of the loads on any element of the barrier, and of their means over 50 ms. Moments are about the
    // elements' feet, those of walls about their lines.
    struct ElementLoads {
        double force = 0.0, force_50ms = 0.0;    // N
        double moment = 0.0, moment_50ms = 0.0;  // N m
    };
    // Motion and loads of the segments of a free-standing barrier, or of posts that yield.
    struct MovingElements {
        // Distances by which the furthest corner of any base moved square to the line, away from the traffic (m): the
        // greatest, and that at the end. Of posts that yield: those of the middle of the top.
        double deflection = 0.0, residual_deflection = 0.0;
        // Angles of posts that yield to the vertical (rad): the greatest of any, and that at the end.
        double tilt = 0.0, residual_tilt = 0.0;
        // Greatest of (|M| + F_z b) / (m b) in means over 50 ms (m/s^2). b is half the base and F_z the vertical
        // force on the segment. M is the moment on it about its long axis, less that of its own inertia.
        double overturning = 0.0;
    };
    struct JointLoads {
        double angle;       // greatest magnitude of the articulation angle (rad)
        double force_50ms;  // greatest magnitude of the mean over 50 ms of the force on the leading unit (N)
        double slip;        // greatest magnitude of the slip (m)
    };
    std::optional<NormalForce> normal_force;
    std::optional<Motion> motion;
    std::optional<Attitude> attitude;
    std::optional<Energy> energy;
    std::optional<FilteredForce> filtered_force;
    // Greatest deceleration along the body's r axis with CFC 60 (m/s^2). It is absent also where `cfc60` is.
    std::optional<double> filtered_deceleration;
    // Greatest distance of an anchor of any unit past the barrier's line (m).
    std::optional<double> penetration;
    // Greatest height of any wheel's lowest point above the ground (m).
    std::optional<double> wheel_climb;
    std::optional<ElementLoads> element_loads;
    std::optional<double> momentum_residual;  // the History::momentum_residual of the run
    std::optional<JointLoads> joint;          // the loads of the first joint
    std::optional<MovingElements> moving_elements;
};

// `history` has all its columns, or those of wanted.channels(). Groups of a barrier or of a joint that is not there are
// absent. The change of velocity and the yaw count until the vehicle separated from the barrier, if it did.
Extremes extremes_of(const History& history, const Vehicle& vehicle, const Barrier* barrier,
                     const ExtremeGroups& wanted, const Event& event);

// These compute one group each.
Extremes::Motion greatest_motion(const History& history, const Event& event);
Extremes::Attitude greatest_attitude(const History& history, const Event& event);
Extremes::JointLoads greatest_joint_loads(const History& history);
double greatest_penetration(const History& history, const Vehicle& vehicle, const Barrier& barrier);
double greatest_wheel_climb(const History& history, const Vehicle& vehicle);
Extremes::ElementLoads greatest_element_loads(const History& history, const Barrier& barrier);
Extremes::MovingElements greatest_movement(const History& history, const Barrier& barrier);

}  // namespace birm3d
