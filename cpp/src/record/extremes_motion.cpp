// Extremes of how the first unit moves and turns.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/channel_filter.hpp"
#include "base/wide_loops.hpp"
#include "birm3d/base/rotation.hpp"
#include "birm3d/record/extremes.hpp"
#include "record/greatest.hpp"
#include "record/resample_rows.hpp"
#include "record/window_sum.hpp"

namespace birm3d {

namespace {

// The last instant that counts where the separation does.
double end_of(const Event& event) {
    return event.separated ? event.released_at : infinity;
}

// Greatest magnitude of an angle that goes on beyond half a turn.
class Turning {
  public:
    explicit Turning(double first, double zero) : zero_(zero), last_(first) {}

    void add(double angle) {
        revolutions_ -= std::round((angle - last_) / (2.0 * std::numbers::pi));
        last_ = angle;
        greatest_ = std::max(greatest_, std::abs(angle + 2.0 * std::numbers::pi * revolutions_ - zero_));
    }
    double greatest() const { return greatest_; }

  private:
    double zero_, last_, revolutions_ = 0.0, greatest_ = 0.0;
};

// Angles of any size.
Extremes::Attitude attitude_at_large(const History& history, double end) {
    const std::vector<Quat>& orientation = history.units.front().orientation;
    const Angles first = roll_pitch_yaw(orientation[0]);
    Turning roll(first.roll, 0.0), pitch(first.pitch, 0.0), yaw(first.yaw, first.yaw);
    for (std::size_t k = 0; k < orientation.size(); ++k) {
        const Angles angles = roll_pitch_yaw(orientation[k]);
        roll.add(angles.roll), pitch.add(angles.pitch);
        if (history.time[k] <= end) yaw.add(angles.yaw);
    }
    return {roll.greatest(), pitch.greatest(), yaw.greatest()};
}

// Tangents and sines of angles at some instants, and what they are made of. Loops over them fill whole registers.
struct SmallAngles {
    SpanColumn up_y, up_z, roll;               // of the rotation's last row; tangent of the roll's magnitude
    SpanColumn sine;                           // of the pitch's magnitude
    SpanColumn front_x, front_y, left, right;  // of its first column; tangents of the yaw to either side
    SpanColumn lean;                           // above minus the least cosine: an angle is large

    void set(const Quat* orientation, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) {
            const Mat3 R = orientation[i].toRotationMatrix();
            up_y[i] = R(2, 1), up_z[i] = R(2, 2), roll[i] = std::abs(R(2, 1)) / R(2, 2);
            sine[i] = std::abs(R(2, 0));
            front_x[i] = R(0, 0), front_y[i] = R(1, 0);
            left[i] = R(1, 0) / R(0, 0), right[i] = -left[i];
            const double least = R(2, 2) < R(0, 0) ? R(2, 2) : R(0, 0);
            lean[i] = 1.0 - sine[i] < least ? sine[i] - 1.0 : -least;
        }
    }
};

// Greatest angles if all stay well below a quarter of a revolution, else none. Tangents and sines have the same order
// as the angles, so that few inverse functions are computed.
std::optional<Extremes::Attitude> attitude_in_small(const History& history, double end) {
    constexpr double least_cosine = 0.1;
    const std::vector<Quat>& orientation = history.units.front().orientation;
    const double zero = roll_pitch_yaw(orientation[0]).yaw;
    const auto magnitude = [](double y, double x) { return std::abs(std::atan2(y, x)); };
    const auto slope = [](double sine, double) { return std::asin(sine); };
    const auto change = [zero](double y, double x) { return std::abs(std::atan2(y, x) - zero); };
    GreatestOf roll(magnitude);
    GreatestOf pitch(slope);
    GreatestOf left(change, zero != 0.0 ? 1.0 : 0.0), right = left;
    // No instant before this one is after the end.
    const auto counting = static_cast<std::size_t>(
        std::upper_bound(history.time.begin(), history.time.end(), end) - history.time.begin());
    SmallAngles angles;
    for (std::size_t first = 0; first < orientation.size(); first += most_together) {
        const std::size_t n = std::min(most_together, orientation.size() - first);
        angles.set(orientation.data() + first, n);
        if (!(greatest_of(angles.lean.data(), n) < -least_cosine)) return std::nullopt;
        roll.add(angles.roll.data(), angles.up_y.data(), angles.up_z.data(), n);
        pitch.add(angles.sine.data(), angles.sine.data(), angles.sine.data(), n);
        if (first >= counting) continue;
        const std::size_t turning = std::min(n, counting - first);
        left.add(angles.left.data(), angles.front_y.data(), angles.front_x.data(), turning);
        right.add(angles.right.data(), angles.front_y.data(), angles.front_x.data(), turning);
    }
    // The first instant is not after the end.
    return Extremes::Attitude{roll.value(), pitch.value(), std::max({0.0, left.value(), right.value()})};
}

}  // namespace

Extremes::Motion greatest_motion(const History& history, const Event& event) {
    const double end = end_of(event);
    const UnitHistory& unit = history.units.front();
    const Vec3 position = unit.position[0], velocity = unit.velocity[0], towards = history.towards;
    Extremes::Motion found{towards, velocity.dot(towards), {}, -infinity, 0.0, -infinity};
    double before = found.approach_speed;  // at the instant before
    double change_squared = 0.0;
    for (std::size_t k = 0; k < history.time.size(); ++k) {
        const double speed = unit.velocity[k].dot(towards);
        if (!found.reversal_time && speed <= 0.0) {
            const double last = history.time[k > 0 ? k - 1 : 0];
            found.reversal_time =
                before > speed ? last + before / (before - speed) * (history.time[k] - last) : last;
        }
        before = speed;
        found.travel = std::max(found.travel, (unit.position[k] - position).dot(towards));
        if (history.time[k] <= end)
            change_squared = std::max(change_squared, (unit.velocity[k] - velocity).squaredNorm());
        found.deceleration = std::max(found.deceleration, -unit.acceleration[k].x());
    }
    found.velocity_change = std::sqrt(change_squared);
    if (event.separated)
        found.velocity_change = std::max(found.velocity_change, (event.released_velocity - velocity).norm());
    return found;
}

Extremes::Attitude greatest_attitude(const History& history, const Event& event) {
    const double end = end_of(event);
    std::optional<Extremes::Attitude> small;
    run_wide([&] { small = attitude_in_small(history, end); });
    return small ? *small : attitude_at_large(history, end);
}

Extremes::JointLoads greatest_joint_loads(const History& history) {
    const JointHistory& joint = history.joints.front();
    Turning angle(joint.angles.front().yaw, 0.0);
    for (const JointAngles& angles : joint.angles)
        angle.add(angles.yaw);
    Extremes::JointLoads found{angle.greatest(), 0.0, 0.0};
    for (const double slip : joint.slip)
        found.slip = std::max(found.slip, std::abs(slip));
    if (joint.force.size() < 2) return found;
    const std::size_t window = rows_in(window_50ms, history.time[1] - history.time[0]);
    WindowSum sum(joint.force, window);
    for (std::size_t k = 0; k < joint.force.size(); ++k)
        found.force_50ms = std::max(found.force_50ms, sum.up_to(k).norm() / static_cast<double>(window));
    return found;
}

}  // namespace birm3d
