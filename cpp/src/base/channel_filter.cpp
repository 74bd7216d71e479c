#include "base/channel_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace birm3d {

namespace {

// Two poles in the direct form I, and the last two rows of two signals before and behind them. In this form only one
// product and one difference wait for the row before.
struct Biquad {
    double b0, b1, b2, a1, a2;
    TwoSignals in1{}, in2{}, out1{}, out2{};

    // State after an infinitely long constant signal.
    void settle(const TwoSignals& value) {
        in1 = in2 = value;
        for (std::size_t i = 0; i < 2; ++i)
            out1[i] = out2[i] = (b0 + b1 + b2) / (1.0 + a1 + a2) * value[i];
    }
    TwoSignals next(const TwoSignals& value) {
        for (std::size_t i = 0; i < 2; ++i) {
            const double out = (b0 * value[i] + b1 * in1[i] + b2 * in2[i] - a2 * out2[i]) - a1 * out1[i];
            in2[i] = in1[i], in1[i] = value[i];
            out2[i] = out1[i], out1[i] = out;
        }
        return out1;
    }
};

Biquad low_pass(double channel_class, double interval) {
    const double wa = std::tan(std::numbers::pi * channel_class * 2.0775 * interval);
    const double norm = 1.0 + std::numbers::sqrt2 * wa + wa * wa;
    const double gain = wa * wa / norm;
    return {gain, 2.0 * gain, gain, 2.0 * (wa * wa - 1.0) / norm,
            (1.0 - std::numbers::sqrt2 * wa + wa * wa) / norm};
}

}  // namespace

std::size_t rows_in(double width, double interval) {
    return static_cast<std::size_t>(std::max(1.0, std::nearbyint(width / interval)));
}

std::optional<TwoSignals> peaks_of_filtered(std::span<const TwoSignals> signal, double channel_class,
                                            double interval) {
    if (signal.empty() || !(interval * channel_class <= 0.1)) return std::nullopt;
    Biquad filter = low_pass(channel_class, interval);
    const std::size_t n = signal.size();
    // Before the start the filter is settled; after the end it runs on for this long.
    const auto padding =
        std::min(n - 1, static_cast<std::size_t>(std::ceil(2.0 / (channel_class * interval))));
    const auto once = std::make_unique_for_overwrite<TwoSignals[]>(n + padding);
    filter.settle(signal.front());
    for (std::size_t k = 0; k < n; ++k)
        once[k] = filter.next(signal[k]);
    for (std::size_t k = n; k < n + padding; ++k)
        once[k] = filter.next(signal.back());
    TwoSignals peak;
    peak.fill(-std::numeric_limits<double>::infinity());
    filter.settle(once[n + padding - 1]);
    for (std::size_t k = n + padding; k-- > n;)
        filter.next(once[k]);
    for (std::size_t k = n; k-- > 0;) {
        const TwoSignals out = filter.next(once[k]);
        for (std::size_t i = 0; i < 2; ++i)
            peak[i] = std::max(peak[i], out[i]);
    }
    return peak;
}

double peak_of_means(std::span<const double> signal, double width, double interval) {
    const std::size_t n = rows_in(width, interval);
    const double rows = static_cast<double>(n);
    double peak = -std::numeric_limits<double>::infinity();
    double now = 0.0, before = 0.0;  // sums up to a row, and up to the one that leaves the window
    for (std::size_t k = 0; k < signal.size(); ++k) {
        now += signal[k];
        if (k >= n) before += signal[k - n];
        peak = std::max(peak, (now - before) / rows);
    }
    return peak;
}

}  // namespace birm3d
