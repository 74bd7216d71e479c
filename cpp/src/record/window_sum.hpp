// Sums over a moving window of a history's rows.
#pragma once

#include <cstddef>
#include <vector>

#include "birm3d/base/types.hpp"

namespace birm3d {

// Sum of the last `window` rows of a column, row after row; zero before the start.
class WindowSum {
  public:
    WindowSum(const std::vector<Vec3>& column, std::size_t window) : column_(column), window_(window) {}

    // The sum of the window that ends at row k. Rows are asked for in order, each once.
    Vec3 up_to(std::size_t k) {
        all_ += column_[k];
        if (k >= window_) left_ += column_[k - window_];
        return all_ - left_;
    }

  private:
    const std::vector<Vec3>& column_;
    std::size_t window_;
    Vec3 all_ = Vec3::Zero(), left_ = all_;  // of the rows up to now, and of those that have left the window
};

}  // namespace birm3d
