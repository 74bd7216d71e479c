#include "birm3d/record/extremes.hpp"

#include <optional>
#include <vector>

#include "base/channel_filter.hpp"
#include "base/wide_loops.hpp"
#include "record/greatest.hpp"

namespace birm3d {

namespace {

// The first two rows are the interval.
double interval_of(const History& history) {
    return history.time.size() > 1 ? history.time[1] - history.time[0] : infinity;
}

// Component of the barrier's force on all units (N).
Column force_on_all(const History& history) {
    Column force(history.time.size(), 0.0);
    for (const UnitHistory& unit : history.units)
        for (std::size_t k = 0; k < force.size(); ++k)
            force[k] += unit.barrier_normal_force[k];
    return force;
}

// Peaks of the force, if there is any, and of the deceleration along r. Both filters at once: each waits for its own
// last result.
std::optional<TwoSignals> filtered_peaks(const History& history, const std::optional<Column>& force,
                                         bool deceleration) {
    std::vector<TwoSignals> signal(history.time.size(), {0.0, 0.0});
    if (force)
        for (std::size_t k = 0; k < signal.size(); ++k)
            signal[k][0] = (*force)[k];
    if (deceleration)
        for (std::size_t k = 0; k < signal.size(); ++k)
            signal[k][1] = -history.units.front().acceleration[k].x();
    return peaks_of_filtered(signal, cfc60, interval_of(history));
}

void find_extremes_of_columns(const History& history, const ExtremeGroups& wanted, Extremes& found) {
    std::optional<Column> force;
    if (wanted.normal_force || wanted.filtered_force) force = force_on_all(history);
    if (wanted.normal_force) found.normal_force = {greatest_of(force->data(), force->size()), force->back()};
    if (!wanted.filtered_force && !wanted.filtered_deceleration) return;
    const std::optional<TwoSignals> peak = filtered_peaks(history, force, wanted.filtered_deceleration);
    if (wanted.filtered_force)
        found.filtered_force = {peak ? std::optional((*peak)[0]) : std::nullopt,
                                peak_of_means(*force, window_50ms, interval_of(history))};
    if (wanted.filtered_deceleration && peak) found.filtered_deceleration = (*peak)[1];
}

}  // namespace

Extremes extremes_of(const History& history, const Vehicle& vehicle, const Barrier* barrier,
                     const ExtremeGroups& wanted, const Event& event) {
    Extremes found;
    found.rows = history.time.size();
    found.end_time = history.time.back();
    run_wide([&] { find_extremes_of_columns(history, wanted, found); });
    if (wanted.energy) found.energy = {history.kinetic_at_start, history.energy_residual};
    if (wanted.motion) found.motion = greatest_motion(history, event);
    if (wanted.attitude) found.attitude = greatest_attitude(history, event);
    if (wanted.wheel_climb) found.wheel_climb = greatest_wheel_climb(history, vehicle);
    if (wanted.momentum) found.momentum_residual = history.momentum_residual;
    if (wanted.joint && !history.joints.empty()) found.joint = greatest_joint_loads(history);
    if (!barrier) return found;
    if (wanted.penetration) found.penetration = greatest_penetration(history, vehicle, *barrier);
    if (wanted.moving_elements && !history.moving_elements.empty())
        found.moving_elements = greatest_movement(history, *barrier);
    if (wanted.element_loads) found.element_loads = greatest_element_loads(history, *barrier);
    return found;
}

}  // namespace birm3d
