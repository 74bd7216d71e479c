#include "birm3d/sim/extremes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "birm3d/base/channel_filter.hpp"
#include "birm3d/base/rotation.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Extremes::NormalForce normal_force(const History& history) {
    Extremes::NormalForce found{-infinity, 0.0};
    for (std::size_t k = 0; k < history.time.size(); ++k) {
        found.last = 0.0;
        for (const UnitHistory& unit : history.units)
            found.last += unit.barrier_normal_force[k];
        found.peak = std::max(found.peak, found.last);
    }
    return found;
}

// The last instant that counts where the separation does.
double end_of(const Event& event) {
    return event.separated ? event.released_at : infinity;
}

Extremes::Motion motion(const History& history, const Event& event) {
    const double end = end_of(event);
    const UnitHistory& unit = history.units.front();
    Extremes::Motion found{history.towards, unit.velocity[0].dot(history.towards), {}, -infinity, 0.0,
                           -infinity};
    double before = found.approach_speed;  // at the instant before
    for (std::size_t k = 0; k < history.time.size(); ++k) {
        const double speed = unit.velocity[k].dot(history.towards);
        if (!found.turn_time && speed <= 0.0) {
            const double last = history.time[k > 0 ? k - 1 : 0];
            found.turn_time =
                before > speed ? last + before / (before - speed) * (history.time[k] - last) : last;
        }
        before = speed;
        found.way = std::max(found.way, (unit.position[k] - unit.position[0]).dot(history.towards));
        if (history.time[k] <= end)
            found.velocity_change =
                std::max(found.velocity_change, (unit.velocity[k] - unit.velocity[0]).norm());
        found.deceleration = std::max(found.deceleration, -unit.acceleration[k].x());
    }
    if (event.separated)
        found.velocity_change =
            std::max(found.velocity_change, (event.released_velocity - unit.velocity[0]).norm());
    return found;
}

// Greatest magnitude of an angle that goes on beyond half a turn.
class Turning {
  public:
    explicit Turning(double first, double zero) : zero_(zero), last_(first) {}

    void add(double angle) {
        turns_ -= std::round((angle - last_) / (2.0 * std::numbers::pi));
        last_ = angle;
        greatest_ = std::max(greatest_, std::abs(angle + 2.0 * std::numbers::pi * turns_ - zero_));
    }
    double greatest() const { return greatest_; }

  private:
    double zero_, last_, turns_ = 0.0, greatest_ = 0.0;
};

Extremes::Attitude attitude(const History& history, const Event& event) {
    const double end = end_of(event);
    const std::vector<Quat>& orientation = history.units.front().orientation;
    const Angles first = roll_pitch_yaw(orientation[0]);
    Turning roll(first.roll, 0.0), pitch(first.pitch, 0.0), yaw(first.yaw, first.yaw);
    for (std::size_t k = 0; k < orientation.size(); ++k) {
        const Angles angles = roll_pitch_yaw(orientation[k]);
        roll.add(angles.roll), pitch.add(angles.pitch);
        if (history.time[k] <= end) yaw.add(angles.yaw);
    }
    return {roll.greatest(), pitch.greatest(), yaw.greatest()};
}

Extremes::Energy energy(const History& history) {
    Extremes::Energy found{history.kinetic[0], 0.0};
    double start = 0.0;
    for (std::size_t k = 0; k < history.time.size(); ++k) {
        double total = 0.0;
        for (const Column* term :
             {&history.kinetic, &history.potential, &history.stored, &history.crushed,
              &history.barrier_friction, &history.tire_friction, &history.ground_friction, &history.impacts,
              &history.segment_friction, &history.joint_work})
            total += (*term)[k];
        if (k == 0) start = total;
        found.residual = std::max(found.residual, std::abs(total - start));
    }
    return found;
}

// The first two rows are the interval.
double interval_of(const History& history) {
    return history.time.size() > 1 ? history.time[1] - history.time[0] : infinity;
}

// Scratch columns stay with their thread: a run's metrics take no memory of their own.
Column& scratch() {
    thread_local Column values;
    return values;
}

Extremes::FilteredForce filtered_force(const History& history) {
    Column& sum = scratch();
    sum.assign(history.time.size(), 0.0);
    for (const UnitHistory& unit : history.units)
        for (std::size_t k = 0; k < sum.size(); ++k)
            sum[k] += unit.barrier_normal_force[k];
    const double interval = interval_of(history);
    return {peak_of_filtered(sum, cfc60, interval), peak_of_means(sum, window_50ms, interval)};
}

std::optional<double> filtered_deceleration(const History& history) {
    Column& deceleration = scratch();
    deceleration.clear();
    for (const Vec3& acceleration : history.units.front().acceleration)
        deceleration.push_back(-acceleration.x());
    return peak_of_filtered(deceleration, cfc60, interval_of(history));
}

Extremes::JointLoads joint_loads(const JointHistory& joint) {
    Turning angle(joint.angles.front().yaw, 0.0);
    double force = 0.0;
    for (const JointAngles& angles : joint.angles)
        angle.add(angles.yaw);
    for (const Vec3& row : joint.force)
        force = std::max(force, row.norm());
    return {angle.greatest(), force};
}

}  // namespace

Extremes extremes_of(const History& history, const Vehicle& vehicle, const Barrier* barrier,
                     const ExtremeGroups& wanted, const Event& event) {
    Extremes found;
    found.rows = history.time.size();
    found.end_time = history.time.back();
    if (wanted.normal_force) found.normal_force = normal_force(history);
    if (wanted.motion) found.motion = motion(history, event);
    if (wanted.attitude) found.attitude = attitude(history, event);
    if (wanted.energy) found.energy = energy(history);
    if (wanted.filtered_force) found.filtered_force = filtered_force(history);
    if (wanted.filtered_deceleration) found.filtered_deceleration = filtered_deceleration(history);
    if (wanted.wheel_climb) found.wheel_climb = greatest_wheel_climb(history, vehicle);
    if (wanted.momentum) found.momentum_residual = history.momentum_residual;
    if (wanted.joint && !history.joints.empty()) found.joint = joint_loads(history.joints.front());
    if (!barrier) return found;
    if (wanted.penetration) found.penetration = greatest_penetration(history, vehicle, *barrier);
    if (wanted.segments && !history.segments.empty()) found.segments = greatest_movement(history, *barrier);
    if (wanted.element_loads) found.element_loads = greatest_element_loads(history, *barrier);
    return found;
}

}  // namespace birm3d
