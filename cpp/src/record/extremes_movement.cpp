// Extremes of what the elements of a barrier that move do.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/channel_filter.hpp"
#include "birm3d/record/extremes.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

struct Ground2 {
    double x, y;
    double dot(const Ground2& other) const { return x * other.x + y * other.y; }
};

// Of the segment's own axes at a row: across it, and along it.
Ground2 across(double angle) {
    return {std::cos(angle), std::sin(angle)};
}
Ground2 along(double angle) {
    return {-std::sin(angle), std::cos(angle)};
}

// Of the four corners of the base along `past`, which is level (m).
std::array<double, 4> corners(const MovingElement& element, const MovingElementHistory& motion,
                              double heading, const Vec3& past, std::size_t row) {
    const double angle = heading + motion.yaw[row];
    const Ground2 past_plane{past.x(), past.y()};
    const double foot = motion.position[row].x() * past.x() + motion.position[row].y() * past.y();
    const double x = element.half_base * across(angle).dot(past_plane);
    const double y = element.half_length * along(angle).dot(past_plane);
    return {foot - x - y, foot + x - y, foot + x + y, foot - x + y};
}

// Greatest overturning of a segment, per its mass and half its base (m/s^2); see Extremes::MovingElements.
double overturning(const MovingElement& element, const MovingElementHistory& motion,
                   const ObstacleHistory* load, double heading, double interval) {
    const std::size_t window = rows_in(window_50ms, interval);
    const double rows = static_cast<double>(window);
    const double mass = element.body.mass, half = element.half_base;
    double greatest = 0.0;
    // Sums of the rows within the window. WindowSum rounds them in another order, which would change the last digits of a
    // metric whose values are committed.
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    for (std::size_t k = 0; k < motion.yaw.size(); ++k) {
        if (load) {
            force += load->force[k], moment += load->moment[k];
            if (k >= window) force -= load->force[k - window], moment -= load->moment[k - window];
        }
        const Vec3 change = motion.velocity[k] - motion.velocity[k >= window ? k - window : 0];
        const double angle = heading + motion.yaw[k];
        const Ground2 acceleration{change.x() / (interval * rows), change.y() / (interval * rows)};
        const double moment_along = Ground2{moment.x() / rows, moment.y() / rows}.dot(along(angle)) -
                                    mass * element.mass_center_height * acceleration.dot(across(angle));
        greatest = std::max(greatest, (std::abs(moment_along) + force.z() / rows * half) / (mass * half));
    }
    return greatest;
}

Extremes::MovingElements greatest_tilt(const History& history, const Barrier& barrier) {
    Extremes::MovingElements found;
    const Vec3 past = -barrier.normal();
    for (std::size_t i = 0; i < history.moving_elements.size(); ++i) {
        const std::vector<Vec3>& axis = history.moving_elements[i].axis;
        const double height = barrier.moving_elements[i].reach;
        double tilt = 0.0, moved = 0.0;
        for (const Vec3& now : axis) {
            tilt = tilt_of(now);
            moved = height * now.dot(past);
            found.tilt = std::max(found.tilt, tilt);
            found.deflection = std::max(found.deflection, moved);
        }
        found.residual_tilt = std::max(found.residual_tilt, tilt);
        found.residual_deflection = std::max(found.residual_deflection, moved);
    }
    return found;
}

}  // namespace

Extremes::MovingElements greatest_movement(const History& history, const Barrier& barrier) {
    if (barrier.yielding) return greatest_tilt(history, barrier);
    Extremes::MovingElements found;
    const Vec3 past = -barrier.normal();
    const std::size_t count = history.time.size();
    for (std::size_t i = 0; i < history.moving_elements.size(); ++i) {
        const MovingElement& element = barrier.moving_elements[i];
        const MovingElementHistory& motion = history.moving_elements[i];
        const std::array<double, 4> start = corners(element, motion, barrier.heading, past, 0);
        for (std::size_t k = 0; k < count; ++k) {
            const std::array<double, 4> now = corners(element, motion, barrier.heading, past, k);
            double moved = 0.0;
            for (std::size_t c = 0; c < now.size(); ++c)
                moved = std::max(moved, now[c] - start[c]);
            found.deflection = std::max(found.deflection, moved);
            if (k + 1 == count) found.residual_deflection = std::max(found.residual_deflection, moved);
        }
        if (count < 2) continue;
        const auto load = std::find_if(history.obstacles.begin(), history.obstacles.end(),
                                       [i](const ObstacleHistory& known) { return known.obstacle == i; });
        found.overturning =
            std::max(found.overturning,
                     overturning(element, motion, load == history.obstacles.end() ? nullptr : &*load,
                                 barrier.heading, history.time[1] - history.time[0]));
    }
    return found;
}

}  // namespace birm3d
