#include "birm3d/record/extremes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "base/channel_filter.hpp"
#include "base/wide_loops.hpp"

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

// Each thread keeps its work buffers, so that the metrics of a run allocate nothing.
Column& scratch() {
    thread_local Column values;
    return values;
}

Extremes::Energy energy(const History& history) {
    Column& total = scratch();
    total.assign(history.time.size(), 0.0);
    for (const Column* term :
         {&history.kinetic, &history.potential, &history.stored, &history.crushed, &history.barrier_friction,
          &history.tire_friction, &history.ground_friction, &history.impacts, &history.segment_friction,
          &history.joint_work, &history.suspension})
        for (std::size_t k = 0; k < total.size(); ++k)
            total[k] += (*term)[k];
    Extremes::Energy found{history.kinetic[0], 0.0};
    for (const double sum : total)
        found.residual = std::max(found.residual, std::abs(sum - total[0]));
    return found;
}

// The first two rows are the interval.
double interval_of(const History& history) {
    return history.time.size() > 1 ? history.time[1] - history.time[0] : infinity;
}

// Both filters at once: each waits for its own last result.
void filter(const History& history, const ExtremeGroups& wanted, Extremes& found) {
    if (!wanted.filtered_force && !wanted.filtered_deceleration) return;
    thread_local std::vector<TwoSignals>
        signal;  // component of the force (N) and deceleration along r (m/s^2)
    signal.assign(history.time.size(), {0.0, 0.0});
    if (wanted.filtered_force)
        for (const UnitHistory& unit : history.units)
            for (std::size_t k = 0; k < signal.size(); ++k)
                signal[k][0] += unit.barrier_normal_force[k];
    if (wanted.filtered_deceleration)
        for (std::size_t k = 0; k < signal.size(); ++k)
            signal[k][1] = -history.units.front().acceleration[k].x();
    const double interval = interval_of(history);
    const std::optional<TwoSignals> peak = peaks_of_filtered(signal, cfc60, interval);
    if (wanted.filtered_force) {
        Column& force = scratch();
        force.resize(signal.size());
        for (std::size_t k = 0; k < signal.size(); ++k)
            force[k] = signal[k][0];
        found.filtered_force = {peak ? std::optional((*peak)[0]) : std::nullopt,
                                peak_of_means(force, window_50ms, interval)};
    }
    if (wanted.filtered_deceleration && peak) found.filtered_deceleration = (*peak)[1];
}

void find_extremes_of_columns(const History& history, const ExtremeGroups& wanted, Extremes& found) {
    if (wanted.normal_force) found.normal_force = normal_force(history);
    if (wanted.energy) found.energy = energy(history);
    filter(history, wanted, found);
}

}  // namespace

Extremes extremes_of(const History& history, const Vehicle& vehicle, const Barrier* barrier,
                     const ExtremeGroups& wanted, const Event& event) {
    Extremes found;
    found.rows = history.time.size();
    found.end_time = history.time.back();
    run_wide([&] { find_extremes_of_columns(history, wanted, found); });
    if (wanted.motion) found.motion = greatest_motion(history, event);
    if (wanted.attitude) found.attitude = greatest_attitude(history, event);
    if (wanted.wheel_climb) found.wheel_climb = greatest_wheel_climb(history, vehicle);
    if (wanted.momentum) found.momentum_residual = history.momentum_residual;
    if (wanted.joint && !history.joints.empty()) found.joint = greatest_joint_loads(history.joints.front());
    if (!barrier) return found;
    if (wanted.penetration) found.penetration = greatest_penetration(history, vehicle, *barrier);
    if (wanted.segments && !history.segments.empty()) found.segments = greatest_movement(history, *barrier);
    if (wanted.element_loads) found.element_loads = greatest_element_loads(history, *barrier);
    return found;
}

}  // namespace birm3d
