// Evenly spaced output, put together; here that of energies and contact forces.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/wide_loops.hpp"
#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"
#include "record/resample_rows.hpp"

namespace birm3d {

History Recorder::resample(const Scene& scene) const {
    History history;
    resample(scene, {}, history);
    return history;
}

void Recorder::resample(const Scene& scene, const Channels& wanted, History& history) const {
    const double interval = scene.settings.output_interval;
    const double end = values_[(rows() - 1) * width_ + at_time];
    // An end that misses an output instant by rounding only still has it.
    if (end > tolerance::most_rows * interval)
        refuse("output_interval",
               "long enough for at most " + to_text(tolerance::most_rows) +
                   " rows, >= " + to_text(end / tolerance::most_rows, 3) + " s",
               interval);
    const auto count = static_cast<std::size_t>(std::floor(end / interval * (1.0 + 1e-12))) + 1;

    history.time.resize(count);
    for (std::size_t k = 0; k < count; ++k)
        history.time[k] = static_cast<double>(k) * interval;

    const OutputInstants output(values_, width_, history.time);
    history.towards = scene.towards();
    if (wanted.energies) run_wide([&] { resample_energies(output, history); });
    if (wanted.energy_residual) find_energy_residual(output, history);
    resample_units(output, scene, wanted, history);
    history.joints.clear();
    history.moving_elements.clear();
    if (wanted.elements)
        resample_obstacles(scene, output, history);
    else
        history.obstacles.clear();
    if (wanted.joints) resample_joints(scene, output, history);
    if (wanted.moving_elements) resample_moving_elements(scene, output, history);
}

void Recorder::resample_energies(const OutputInstants& output, History& history) const {
    for (std::size_t i = 0; i < energy_terms.size(); ++i) {
        const std::size_t e = at_energies + i;
        Column& column = history.energies[i];
        column.assign(history.time.size(), values_[e]);
        for (const Span& span : output.span) {
            const double a = values_[span.row * width_ + e], b = values_[(span.row + 1) * width_ + e];
            for (std::size_t k = span.first; k < span.end; ++k)
                column[k] = a + output.fraction[k] * (b - a);
        }
    }
}

// Within a step each energy changes evenly, so that the greatest departure is at an end of a span.
void Recorder::find_energy_residual(const OutputInstants& output, History& history) const {
    static_assert(energy_terms[0].value == &Energies::kinetic);
    const double* kinetic = values_.data() + at_energies;
    const auto total = [&](std::size_t row) {
        const double* energies = kinetic + row * width_;
        return std::accumulate(energies, energies + (at_units - at_energies), 0.0);
    };
    history.kinetic_at_start = *kinetic;
    history.energy_residual = 0.0;
    double start = total(0);
    for (const Span& span : output.span) {
        const double a = total(span.row), b = total(span.row + 1);
        if (span.first == 0) {
            const double fraction = output.fraction[0], first = kinetic[span.row * width_];
            start = a + fraction * (b - a);
            history.kinetic_at_start = first + fraction * (kinetic[(span.row + 1) * width_] - first);
        }
        for (const std::size_t k : {span.first, span.end - 1})
            history.energy_residual =
                std::max(history.energy_residual, std::abs(a + output.fraction[k] * (b - a) - start));
    }
}

void Recorder::resample_contact_forces(const OutputInstants& output, std::size_t offset,
                                       UnitHistory& unit) const {
    unit.sum_of_contact_forces.assign(output.time.size(), 0.0);
    double before_step = 0.0, previous = 0.0;  // impulses up to the step's start and the instant before
    std::size_t row = 0;
    for (const Span& span : output.span) {
        for (; row < span.row; ++row) {
            const StepView whole = output.view(row, offset);
            before_step += whole.contact_impulse(whole.dt);
        }
        const StepView step = output.view(row, offset);
        for (std::size_t k = span.first; k < span.end; ++k) {
            const double now = before_step + step.contact_impulse(output.within[k]);
            if (k > 0) unit.sum_of_contact_forces[k] = output.per[k] * (now - previous);
            previous = now;
        }
    }
    show_first_mean(unit.sum_of_contact_forces);
}

}  // namespace birm3d
