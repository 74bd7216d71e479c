// Extremes of the loads on the elements of a barrier.
#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "birm3d/base/channel_filter.hpp"
#include "birm3d/sim/extremes.hpp"

namespace birm3d {

namespace {

// A wall or a concrete barrier overturns about its line; posts and meshes may any way.
std::optional<Vec3> line_of(const Barrier& barrier, const Shape& shape) {
    if (!std::holds_alternative<HalfSpace>(shape) && !std::holds_alternative<Prism>(shape))
        return std::nullopt;
    return Vec3(-std::sin(barrier.heading), std::cos(barrier.heading), 0.0);
}

double overturning(const Vec3& moment, const std::optional<Vec3>& line) {
    return line ? std::abs(moment.dot(*line)) : std::hypot(moment.x(), moment.y());
}

}  // namespace

Extremes::ElementLoads greatest_element_loads(const History& history, const Barrier& barrier) {
    Extremes::ElementLoads found;
    const std::size_t count = history.time.size();
    if (count < 2) return found;
    const std::size_t window = rows_in(window_50ms, history.time[1] - history.time[0]);
    const double rows = static_cast<double>(window);
    for (const ObstacleHistory& of : history.obstacles) {
        const std::optional<Vec3> line = line_of(barrier, barrier.elements[of.obstacle].shape);
        Vec3 force = Vec3::Zero(), moment = Vec3::Zero();   // sums of the rows up to now
        Vec3 force_before = force, moment_before = moment;  // and of those that have left the window
        double force_squared = 0.0, mean_squared = 0.0;
        for (std::size_t k = 0; k < count; ++k) {
            force += of.force[k], moment += of.moment[k];
            if (k >= window) force_before += of.force[k - window], moment_before += of.moment[k - window];
            force_squared = std::max(force_squared, of.force[k].squaredNorm());
            mean_squared = std::max(mean_squared, ((force - force_before) / rows).squaredNorm());
            found.moment = std::max(found.moment, overturning(of.moment[k], line));
            found.moment_50ms =
                std::max(found.moment_50ms, overturning(Vec3((moment - moment_before) / rows), line));
        }
        found.force = std::max(found.force, std::sqrt(force_squared));
        found.force_50ms = std::max(found.force_50ms, std::sqrt(mean_squared));
    }
    return found;
}

}  // namespace birm3d
