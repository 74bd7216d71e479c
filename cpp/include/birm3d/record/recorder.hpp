// The history of a run. One row is kept for each accepted step; evenly spaced output is made from the rows
// afterwards, so that the output interval costs nothing while stepping and does not bound the step.
//
// Within a step, contact forces follow a parabola whose integral is the impulse of the scheme. The impulses of
// lasting rigid contacts are spread evenly over the step. A rigid impact acts at the instant at which it happens.
// Velocities at output instants follow from these impulses, and forces are means over the output interval. So m *
// (change of velocity) equals the sum of forces times the interval, to rounding.
#pragma once

#include <array>
#include <vector>

#include "birm3d/scene/scene.hpp"

namespace birm3d {

struct ContactImpulses;
struct Trial;

// Columns at the output instants 0, interval, 2 interval, ...; n rows.
struct UnitHistory {
    std::vector<Vec3> position;             // mass centre, world (m)
    std::vector<Quat> orientation;          // body to world
    std::vector<Vec3> velocity;             // mass centre, world (m/s)
    std::vector<Vec3> angular_velocity;     // body axes (rad/s)
    std::vector<Vec3> acceleration;         // mass centre, mean over the interval, body axes (m/s^2)
    std::vector<Vec3> barrier_force;        // on the vehicle, mean over the interval, world (N)
    std::vector<Vec3> ground_force;         // of the ground on the skin, the same (N)
    std::vector<Vec3> tire_friction_force;  // the same, tangential to the ground (N)
    Column barrier_normal_force;            // component of barrier_force against History::towards (N)
    Column sum_of_contact_forces;  // magnitudes of the normal forces of all nodes, mean over the interval (N)
    std::vector<Vec3> joint_force;      // of all its joints, mean over the interval, world (N)
    std::vector<Column> tire_reaction;  // (wheels)(n) normal force, mean over the interval (N)
};

// What one element of the barrier feels, means over the interval, world axes.
struct ObstacleHistory {
    std::size_t obstacle;      // place in Barrier::elements
    std::vector<Vec3> force;   // N
    std::vector<Vec3> moment;  // about the element's foot (N m)
};

// A free-standing segment of the barrier, or a post that yields.
struct MovingElementHistory {
    std::vector<Vec3> position;  // foot of its axis, world (m)
    std::vector<Vec3> velocity;  // mass centre, world (m/s)
    Column yaw, yaw_rate;        // from the start, about the vertical (rad, rad/s)
    std::vector<Vec3> axis;      // of a post that yields: unit vector along it, upwards, world
};

struct JointHistory {
    std::vector<Vec3> force;          // on the leading unit, mean over the interval, world (N)
    std::vector<Vec3> moment;         // the same, about the joint's place (N m)
    std::vector<JointAngles> angles;  // of the trailing unit from the leading one
    Column slip;                      // how far the trailing unit has slid forwards (m)
};

struct History {
    // Of one term of the energy balance (J).
    const Column& energy(double Energies::* term) const { return energies[index_of(term)]; }

    Column time;  // s
    Vec3
        towards;  // unit vector: towards the barrier, square to its line; of a path along the line that of the path
    std::vector<UnitHistory> units;
    std::vector<ObstacleHistory> obstacles;  // of the elements that were touched
    std::vector<JointHistory> joints;
    // Of a barrier that moves, in the order of its elements.
    std::vector<MovingElementHistory> moving_elements;
    std::array<Column, energy_terms.size()> energies;  // in the order of energy_terms (J)
    double kinetic_at_start = 0.0;                     // at the first instant (J)
    double energy_residual =
        0.0;  // greatest departure of the sum of all energies from that at that instant (J)
    double momentum_residual = 0.0;  // max |m a - sum of forces| / max |force|, over all units
};

// Which columns of a history are wanted.
struct Channels {
    bool energies = true;
    bool energy_residual = true;  // History::energy_residual and kinetic_at_start
    bool normal_force = true;
    bool motion = true;
    bool angular_velocity = true;  // only with the motion
    bool forces = true;            // all other forces on the units; only with the motion
    bool momentum = true;          // History::momentum_residual; only with the motion
    bool contact_forces = true;    // UnitHistory::sum_of_contact_forces
    bool elements = true;          // loads on the elements of the barrier
    bool joints = true;            // only with the motion
    bool moving_elements = true;
};

struct OutputInstants;

class Recorder {
  public:
    Recorder(const Scene& scene, const State& start);

    // Another record of the same vehicle, in the same memory.
    void restart(const Scene& scene, const State& start);

    // A step that was accepted. A rigid impact at one of its ends is a row, and a step without length, of its own.
    void add(const Scene& scene, const Trial& accepted);

    std::size_t rows() const { return values_.size() / width_; }
    bool full() const;  // is there no room for another step?
    History resample(const Scene& scene) const;

    // The same in the memory of another history; columns that are not wanted have no rows.
    void resample(const Scene& scene, const Channels& wanted, History& history) const;

  private:
    struct Loads {
        const std::vector<UnitState>& units;
        const std::vector<BodyState>* bodies;  // of the units, beside an impact; null: as these have them
        const std::vector<BodyState>& moving_elements;
        const std::vector<ContactImpulses>& impulses;
        const std::vector<Wrench>& joint_impulses;
        bool curved;  // do the forces of the step that leads to this row follow a parabola?
    };
    struct ObstacleRow {
        std::size_t row, obstacle;
        std::array<double, 18> values;
    };

    void add_row(const Scene& scene, double time, const Energies& energies, const Loads& loads);
    ObstacleRow& obstacle_row(std::size_t row, std::size_t obstacle);
    void resample_energies(const OutputInstants& output, History& history) const;
    void find_energy_residual(const OutputInstants& output, History& history) const;
    void resample_contact_forces(const OutputInstants& output, std::size_t offset, UnitHistory& unit) const;
    void resample_units(const OutputInstants& output, const Scene& scene, const Channels& wanted,
                        History& history) const;
    void resample_obstacles(const Scene& scene, const OutputInstants& output, History& history) const;
    void resample_moving_elements(const Scene& scene, const OutputInstants& output, History& history) const;
    void resample_joints(const Scene& scene, const OutputInstants& output, History& history) const;

    std::size_t width_;  // numbers in a row
    Column values_;      // (rows * width), flat: adding a row allocates only when the buffer grows
    std::vector<ObstacleRow> obstacles_;  // rows in order; none where nothing is touched
};

}  // namespace birm3d
