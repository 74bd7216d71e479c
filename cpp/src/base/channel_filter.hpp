// Peaks of filtered signals, as crash testing reports them: channel frequency classes (SAE J211-1) and moving means.
#pragma once

#include <array>
#include <optional>
#include <span>

namespace birm3d {

inline constexpr double cfc60 = 60.0;
inline constexpr double window_50ms = 0.05;  // s

// Rows of a moving mean of this width; both in s.
std::size_t rows_in(double width, double interval);

// Two signals are filtered together. Each row of a filter depends on the row before, so that one signal would leave
// the processor idle.
using TwoSignals = std::array<double, 2>;

// Greatest value of each signal, filtered by a channel frequency class: two-pole Butterworth low-pass, forwards and
// backwards, with the corner 2.0775 times the class (Hz), pre-warped; a signal is constant before its start and after
// its end. Absent where the interval (s) is above a tenth of the class's period, which J211-1 does not allow.
std::optional<TwoSignals> peaks_of_filtered(std::span<const TwoSignals> signals, double channel_class,
                                            double interval);

// Greatest mean over a window of `width` that ends at a row; zero before the start.
double peak_of_means(std::span<const double> signal, double width, double interval);

}  // namespace birm3d
