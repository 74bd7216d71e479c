// Extremes of the loads on the elements of a barrier.
#include <algorithm>
#include <cmath>
#include <variant>

#include "base/channel_filter.hpp"
#include "birm3d/record/extremes.hpp"
#include "record/greatest.hpp"
#include "record/window_sum.hpp"

namespace birm3d {

namespace {

// A wall or a concrete barrier overturns about its line; posts and meshes may any way.
bool overturns_about_line(const Shape& shape) {
    return std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<Prism>(shape);
}

// Greatest overturning moment.
class Overturning {
  public:
    Overturning(const Barrier& barrier, const Shape& shape)
        : about_line_only_(overturns_about_line(shape)),
          line_(-std::sin(barrier.heading), std::cos(barrier.heading), 0.0),
          any_direction_([](double x, double y) { return std::hypot(x, y); }) {}

    void add(const Vec3& moment) {
        if (about_line_only_)
            about_line_ = std::max(about_line_, std::abs(moment.dot(line_)));
        else
            any_direction_.add(moment.x() * moment.x() + moment.y() * moment.y(), moment.x(), moment.y());
    }
    double greatest() const { return about_line_only_ ? about_line_ : any_direction_.value(); }

  private:
    bool about_line_only_;
    Vec3 line_;
    double about_line_ = 0.0;
    GreatestOf<double (*)(double, double)> any_direction_;
};

}  // namespace

Extremes::ElementLoads greatest_element_loads(const History& history, const Barrier& barrier) {
    Extremes::ElementLoads found;
    const std::size_t count = history.time.size();
    if (count < 2) return found;
    const std::size_t window = rows_in(window_50ms, history.time[1] - history.time[0]);
    const double rows = static_cast<double>(window);
    for (const ObstacleHistory& loads : history.obstacles) {
        WindowSum force(loads.force, window), moment(loads.moment, window);
        double force_squared = 0.0, sum_squared = 0.0;
        Overturning at_once(barrier, barrier.elements[loads.obstacle].shape), sums = at_once;
        for (std::size_t k = 0; k < count; ++k) {
            force_squared = std::max(force_squared, loads.force[k].squaredNorm());
            sum_squared = std::max(sum_squared, force.up_to(k).squaredNorm());
            at_once.add(loads.moment[k]), sums.add(moment.up_to(k));
        }
        found.moment = std::max(found.moment, at_once.greatest());
        found.moment_50ms = std::max(found.moment_50ms, sums.greatest() / rows);
        found.force = std::max(found.force, std::sqrt(force_squared));
        found.force_50ms = std::max(found.force_50ms, std::sqrt(sum_squared) / rows);
    }
    return found;
}

}  // namespace birm3d
