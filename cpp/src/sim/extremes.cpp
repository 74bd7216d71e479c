#include "birm3d/sim/extremes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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

}  // namespace

Extremes extremes_of(const History& history, const ExtremeGroups& wanted, const Event& event) {
    Extremes found;
    found.rows = history.time.size();
    found.end_time = history.time.back();
    if (wanted.normal_force) found.normal_force = normal_force(history);
    if (wanted.motion) found.motion = motion(history, event);
    if (wanted.attitude) found.attitude = attitude(history, event);
    if (wanted.energy) found.energy = energy(history);
    return found;
}

}  // namespace birm3d
