// Greatest values of costly functions over many rows.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace birm3d {

// The greatest value of f(x, y) over many pairs. A cheap key orders the values, so that f is computed only where the
// key does not exclude the greatest. The result equals the maximum of all values, bit for bit. For that, values must
// differ by more than f's rounding wherever keys differ by more than the margin.
template <class F>
class GreatestOf {
  public:
    // Keys are distinguished relative to themselves, or to `scale` if that is greater.
    explicit GreatestOf(F f, double scale = 0.0) : f_(f), scale_(scale) {}

    void add(double key, double x, double y) {
        const double margin = apart * std::max(std::abs(best_), scale_);
        if (key > best_ + margin || best_ == -infinity) {
            best_ = key, x_ = x, y_ = y;
            greatest_ = -infinity;
        } else if (key >= best_ - margin) {
            best_ = std::max(best_, key);
            greatest_ = std::max(greatest_, f_(x, y));
        }
    }
    double value() const { return best_ == -infinity ? -infinity : std::max(greatest_, f_(x_, y_)); }

  private:
    static constexpr double apart = 1e-12;
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    F f_;
    double scale_;
    double best_ = -infinity;      // greatest key
    double x_ = 0.0, y_ = 0.0;     // the pair that it was first seen at
    double greatest_ = -infinity;  // of the pairs whose keys were about the same
};

}  // namespace birm3d
