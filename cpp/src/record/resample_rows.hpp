// The output instants of a record, and integrals of loads from one row of the record to each instant.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "record/recorder_rows.hpp"

namespace birm3d {

// Most output instants that are computed together: their numbers fit the first-level cache.
inline constexpr std::size_t most_together = 64;

// One number at each of them.
using SpanColumn = std::array<double, most_together>;

// Output instants [first, end) within the step that begins at `row`.
struct Span {
    std::size_t row, first, end;
    std::size_t size() const { return end - first; }
};

// Columns are of the output instants.
struct OutputInstants {
    const Column& values;  // of the record
    std::size_t width, rows;
    const Column& time;      // s
    Column within;           // from the start of the step (s)
    Column fraction;         // fraction of the step that has passed
    Column smooth;           // s^2 (3 - 2 s) of that fraction s
    Column interval;         // since the instant before; of the first one 1 (s)
    Column per;              // the inverse of that (1/s)
    std::vector<Span> span;  // in order; none where no step was taken

    // Of a record of `rows` rows of `width` numbers.
    OutputInstants(const Column& values_, std::size_t width_, const Column& time_)
        : values(values_), width(width_), rows(values_.size() / width_), time(time_) {
        find_spans();
        const std::size_t count = time.size();
        within.resize(count), fraction.resize(count, 1.0), smooth.resize(count, 1.0);
        interval.resize(count, 1.0), per.resize(count, 1.0);
        for (const Span& s : span) {
            const double start = time_at(s.row), dt = time_at(s.row + 1) - start;
            for (std::size_t k = s.first; k < s.end; ++k) {
                within[k] = std::clamp(time[k] - start, 0.0, dt);
                fraction[k] = dt > 0.0 ? within[k] / dt : 1.0;
                smooth[k] = fraction[k] * fraction[k] * (3.0 - 2.0 * fraction[k]);
            }
        }
        for (std::size_t k = 1; k < count; ++k)
            interval[k] = time[k] - time[k - 1];
        for (std::size_t k = 1; k < count; ++k)
            per[k] = 1.0 / interval[k];
    }

    double time_at(std::size_t row) const { return values[row * width + at_time]; }
    // Of the step that begins at a row, the numbers that begin at `offset`.
    StepView view(std::size_t row, std::size_t offset) const {
        const double* a = values.data() + row * width + offset;
        return {a, a + width, time_at(row + 1) - time_at(row)};
    }

    // Impulse from the start of the step to each instant of a force with end values a and b; `curvature` as
    // of StepView::force_integral, `impulse` is spread evenly (N s).
    void integrate(const Span& s, double a, double b, double curvature, double impulse, double* to) const {
        const double *t = within.data() + s.first, *u = fraction.data() + s.first,
                     *w = smooth.data() + s.first;
        for (std::size_t i = 0, n = s.size(); i < n; ++i)
            to[i] = t[i] * (a + 0.5 * u[i] * (b - a)) + w[i] * curvature + u[i] * impulse;
    }
    // Impulse from the start of the step to each instant of one that is spread evenly (N s).
    void spread(const Span& s, double impulse, double* to) const {
        const double* u = fraction.data() + s.first;
        for (std::size_t i = 0, n = s.size(); i < n; ++i)
            to[i] = u[i] * impulse;
    }

  private:
    void find_spans() {
        if (rows < 2) return;
        std::size_t row = 0, first = 0;
        const std::size_t count = time.size();
        while (first < count) {
            while (row + 2 < rows && time_at(row + 1) <= time[first])
                ++row;
            const bool last = row + 2 == rows;
            std::size_t end = first + 1;
            while (end < count && end - first < most_together && (last || time[end] < time_at(row + 1)))
                ++end;
            span.push_back({row, first, end});
            first = end;
        }
    }
};

// No interval ends at the first instant: it shows the means of the one that begins there.
template <class T>
void show_first_mean(std::vector<T>& column) {
    if (column.size() > 1) column[0] = column[1];
}

}  // namespace birm3d
