// Greatest values over many rows, and of costly functions over them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "birm3d/base/types.hpp"

namespace birm3d {

// Eight columns, so that a loop over many numbers fills whole registers.
inline double greatest_of(const double* values, std::size_t n) {
    constexpr std::size_t columns = 8;
    double most[columns];
    for (double& column : most)
        column = -infinity;
    std::size_t i = 0;
    for (; i + columns <= n; i += columns)
        for (std::size_t c = 0; c < columns; ++c)
            most[c] = values[i + c] > most[c] ? values[i + c] : most[c];
    for (; i < n; ++i)
        most[0] = values[i] > most[0] ? values[i] : most[0];
    return *std::max_element(most, most + columns);
}

// The greatest value of f(x, y) over many pairs. A cheap key orders the values, so that f is computed only where the
// key does not exclude the greatest. The result equals the maximum of all values, bit for bit. For that, values must
// differ by more than f's rounding wherever keys differ by more than the margin.
template <class F>
class GreatestOf {
  public:
    // Keys are distinguished relative to themselves, or to `scale` if that is greater.
    explicit GreatestOf(F f, double scale = 0.0) : f_(f), scale_(scale) {}

    void add(double key, double x, double y) {
        const double margin = margin_at(best_);
        if (key > best_ + margin || best_ == -infinity) {
            best_ = key, x_ = x, y_ = y;
            greatest_ = -infinity;
        } else if (key >= best_ - margin) {
            best_ = std::max(best_, key);
            greatest_ = std::max(greatest_, f_(x, y));
        }
    }
    // Many pairs, of which only those count whose keys are about the greatest.
    void add(const double* key, const double* x, const double* y, std::size_t n) {
        const double greatest = greatest_of(key, n), least = greatest - margin_at(greatest);
        if (best_ != -infinity && greatest < best_ - margin_at(best_)) return;
        for (std::size_t i = 0; i < n; ++i)
            if (key[i] >= least) add(key[i], x[i], y[i]);
    }
    double value() const { return best_ == -infinity ? -infinity : std::max(greatest_, f_(x_, y_)); }

  private:
    static constexpr double apart = 1e-12;

    double margin_at(double key) const { return apart * std::max(std::abs(key), scale_); }

    F f_;
    double scale_;
    double best_ = -infinity;      // greatest key
    double x_ = 0.0, y_ = 0.0;     // the pair that it was first seen at
    double greatest_ = -infinity;  // of the pairs whose keys were about the same
};

}  // namespace birm3d
