// The output instants of a record, and integrals of loads from one row of the record to each instant.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "base/block_loop.hpp"
#include "base/wide_loops.hpp"
#include "record/recorder_rows.hpp"

namespace birm3d {

// Most output instants that are computed together: their numbers fit the first-level cache.
inline constexpr std::size_t most_together = 64;

// Numbers in the widest register.
inline constexpr std::size_t register_length = 8;
static_assert(most_together % register_length == 0);

// One number at each of them.
using SpanColumn = std::array<double, most_together>;

// Output instants [first, end) within the step that begins at `row`.
struct Span {
    std::size_t row, first, end;
    std::size_t size() const { return end - first; }
    // Up to a whole number of registers: loops over columns go on beyond the span, where their results are not used.
    std::size_t filled() const { return (size() + register_length - 1) / register_length * register_length; }
};

// Columns are of the output instants and of one register more.
struct OutputInstants {
    const Column& values;  // of the record
    std::size_t width, rows;
    const Column& time;      // s
    Column within;           // from the start of the step (s)
    Column fraction;         // fraction of the step that has passed
    Column smooth;           // s^2 (3 - 2 s) of that fraction s
    Column per;              // the inverse of the interval since the instant before; of the first one 1 (1/s)
    std::vector<Span> span;  // in order; none where no step was taken

    // Of a record of `rows` rows of `width` numbers.
    OutputInstants(const Column& values_, std::size_t width_, const Column& time_)
        : values(values_), width(width_), rows(values_.size() / width_), time(time_) {
        find_spans();
        const std::size_t count = time.size() + register_length;
        within.resize(count), fraction.resize(count, 1.0), smooth.resize(count, 1.0);
        per.resize(count, 1.0);
        run_wide([&] { place_instants(); });
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
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < s.filled(); ++i)
            to[i] = t[i] * (a + 0.5 * u[i] * (b - a)) + w[i] * curvature + u[i] * impulse;
    }
    // Means over the intervals that end at the instants, of what has the integral `sum`; `previous`: the instant before.
    void means(const Span& s, const SpanColumn& sum, double previous, SpanColumn& to) const {
        const double* rate = per.data() + s.first;
        to[0] = rate[0] * (sum[0] - previous);
        BIRM3D_INDEPENDENT
        for (std::size_t i = 1; i < s.size(); ++i)
            to[i] = rate[i] * (sum[i] - sum[i - 1]);
    }
    // Impulse from the start of the step to each instant of one that is spread evenly (N s).
    void spread(const Span& s, double impulse, double* to) const {
        const double* u = fraction.data() + s.first;
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < s.filled(); ++i)
            to[i] = u[i] * impulse;
    }

  private:
    void place_instants() {
        const double* t = time.data();
        double *after = within.data(), *part = fraction.data(), *s_curve = smooth.data(), *rate = per.data();
        for (const Span& s : span) {
            const double start = time_at(s.row), dt = time_at(s.row + 1) - start;
            if (!(dt > 0.0)) continue;
            BIRM3D_INDEPENDENT
            for (std::size_t k = s.first; k < s.end; ++k) {
                const double passed = t[k] - start;
                after[k] = passed < 0.0 ? 0.0 : (passed > dt ? dt : passed);
                part[k] = after[k] / dt;
                s_curve[k] = part[k] * part[k] * (3.0 - 2.0 * part[k]);
            }
        }
        BIRM3D_INDEPENDENT
        for (std::size_t k = 1; k < time.size(); ++k)
            rate[k] = 1.0 / (t[k] - t[k - 1]);
    }
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
