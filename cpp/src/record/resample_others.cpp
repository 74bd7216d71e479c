// Resampling of what joints, elements of the barrier and those of them that move do.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/wide_loops.hpp"
#include "birm3d/base/rotation.hpp"
#include "kernels/joints.hpp"
#include "record/resample_rows.hpp"

namespace birm3d {

namespace {

// How far the trailing unit has slid forwards (m). Zero where the joint does not slide.
Column slips(const Joint& joint, const History& history) {
    const UnitHistory &leading = history.units[joint.leading], &trailing = history.units[joint.trailing];
    Column slip(history.time.size(), 0.0);
    if (joint.kind != JointKind::sliding) return slip;
    for (std::size_t k = 0; k < history.time.size(); ++k) {
        BodyState ahead, behind;
        ahead.position = leading.position[k], ahead.orientation = leading.orientation[k];
        behind.position = trailing.position[k], behind.orientation = trailing.orientation[k];
        slip[k] = slip_of(joint, ahead, behind);
    }
    return slip;
}

}  // namespace

void Recorder::resample_joints(const Scene& scene, const OutputInstants& output, History& history) const {
    const std::vector<Joint>& joints = scene.vehicle->joints;
    const std::size_t first = width_ - element_width * scene.moving_count() - joint_width * joints.size(),
                      count = history.time.size();
    for (std::size_t j = 0; j < joints.size(); ++j) {
        JointHistory joint;
        joint.force.assign(count, Vec3::Zero());
        joint.moment.assign(count, Vec3::Zero());
        const auto& leading = history.units[joints[j].leading].orientation;
        const auto& trailing = history.units[joints[j].trailing].orientation;
        for (std::size_t k = 0; k < count; ++k)
            joint.angles.push_back(joint_angles(leading[k], trailing[k]));
        joint.slip = slips(joints[j], history);

        const auto add = [&](std::size_t row, double fraction, Wrench& sum) {
            const double* impulse = output.view(row, first + j * joint_width).b;
            sum += {fraction * vec(impulse), fraction * vec(impulse + 3)};
        };
        Wrench before_step, previous;
        std::size_t row = 0;
        for (const Span& span : output.span) {
            for (; row < span.row; ++row)
                add(row, 1.0, before_step);
            for (std::size_t k = span.first; k < span.end; ++k) {
                Wrench now = before_step;
                add(row, output.fraction[k], now);
                if (k > 0) {
                    joint.force[k] = output.per[k] * (now.force - previous.force);
                    joint.moment[k] = output.per[k] * (now.torque - previous.torque);
                }
                previous = now;
            }
        }
        if (count > 1) joint.force[0] = joint.force[1], joint.moment[0] = joint.moment[1];
        history.joints.push_back(std::move(joint));
    }
}

namespace {

using ObstacleNumbers = std::array<double, obstacle_width>;

// Means over the output intervals of the force and torque on one obstacle.
// `loads`: the numbers of each row; null where the obstacle has none.
// `lever`: from the point of the means' torque to that of the record's (m).
void set_means(const OutputInstants& output, const std::vector<const ObstacleNumbers*>& loads,
               const Vec3& lever, ObstacleHistory& means) {
    static constexpr ObstacleNumbers nothing{};
    const auto view = [&](std::size_t r) {
        const auto values = [&](std::size_t i) { return loads[i] ? loads[i]->data() : nothing.data(); };
        return StepView{values(r), values(r + 1), output.time_at(r + 1) - output.time_at(r)};
    };
    std::array<double, 6> before_step{}, previous{};
    std::array<SpanColumn, 6> now, mean;
    std::size_t row = 0;
    for (const Span& span : output.span) {
        for (; row < span.row; ++row) {
            if (!loads[row] && !loads[row + 1]) continue;
            const StepView whole = view(row);
            for (std::size_t i = 0; i < 6; ++i)
                before_step[i] += whole.force_integral(at_load + i, at_load_curvature + i, whole.dt) +
                                  whole.impulse(at_load_impulse + i, whole.dt);
        }
        if (!loads[row] && !loads[row + 1] && previous == before_step) continue;
        const StepView step = view(row);
        for (std::size_t i = 0; i < 6; ++i) {
            output.integrate(span, step.a[at_load + i], step.b[at_load + i], step.b[at_load_curvature + i],
                             step.b[at_load_impulse + i], now[i].data());
            for (std::size_t n = 0; n < span.size(); ++n)
                now[i][n] += before_step[i];
        }
        const std::size_t n = span.size(), skipped = span.first == 0 ? 1 : 0;
        for (std::size_t i = 0; i < 6; ++i) {
            output.means(span, now[i], previous[i], mean[i]);
            previous[i] = now[i][n - 1];
        }
        for (std::size_t k = 0; k < n; ++k) {
            mean[3][k] += lever.y() * mean[2][k] - lever.z() * mean[1][k];
            mean[4][k] += lever.z() * mean[0][k] - lever.x() * mean[2][k];
            mean[5][k] += lever.x() * mean[1][k] - lever.y() * mean[0][k];
        }
        for (std::size_t i = 0; i < 6; ++i) {
            Vec3* to = (i < 3 ? means.force : means.moment).data() + span.first;
            for (std::size_t k = skipped; k < n; ++k)
                to[k][static_cast<Eigen::Index>(i % 3)] = mean[i][k];
        }
    }
    show_first_mean(means.force);
    show_first_mean(means.moment);
}

}  // namespace

// Forces and torques on the obstacles that were touched, as means over the output intervals.
void Recorder::resample_obstacles(const Scene& scene, const OutputInstants& output, History& history) const {
    std::map<std::size_t, std::vector<const ObstacleNumbers*>> touched;  // obstacle -> (rows)
    for (const ObstacleRow& row : obstacles_) {
        auto& rows_of = touched[row.obstacle];
        rows_of.resize(rows(), nullptr);
        rows_of[row.row] = &row.values;
    }
    history.obstacles.resize(touched.size());
    std::size_t place = 0;
    for (const auto& [obstacle, rows_of] : touched) {
        ObstacleHistory& means = history.obstacles[place++];
        means.obstacle = obstacle;
        means.force.assign(history.time.size(), Vec3::Zero());
        means.moment.assign(history.time.size(), Vec3::Zero());
        const auto& loads = rows_of;  // lambdas take no structured bindings
        // Loads of a post are recorded about its centre of rotation, which may be below the ground.
        Vec3 lever = scene.from_origin;
        if (scene.tilts()) lever.z() += scene.barrier->elements[obstacle].position.z();
        run_wide([&] { set_means(output, loads, lever, means); });
    }
}

// Between rows a moving element is moved by the recorded load of the vehicle. Ground and pins make up the rest of its change
// of velocity, which is spread evenly over the step. So the momentum of all bodies adds up at every instant.
void Recorder::resample_moving_elements(const Scene& scene, const OutputInstants& output,
                                        History& history) const {
    const std::size_t moving_elements = scene.moving_count(), count = history.time.size();
    const std::size_t first = width_ - element_width * moving_elements;
    static constexpr std::array<double, obstacle_width> nothing{};
    for (std::size_t i = 0; i < moving_elements; ++i) {
        const RigidBody& body = scene.barrier->moving_elements[i].body;
        const double height = scene.barrier->moving_elements[i].mass_center_height;
        std::vector<const double*> loads(rows(), nothing.data());
        for (const ObstacleRow& row : obstacles_)
            if (row.obstacle == i) loads[row.row] = row.values.data();
        const auto at = [&](std::size_t row) {
            return values_.data() + row * width_ + first + i * element_width;
        };

        MovingElementHistory element;
        std::size_t span = 0;
        double yaw = 0.0, last_angle = 0.0;
        for (std::size_t k = 0; k < count; ++k) {
            while (span + 1 < output.span.size() && output.span[span].end <= k)
                ++span;
            const std::size_t row = output.span.empty() ? 0 : output.span[span].row;
            const std::size_t next = rows() > 1 ? row + 1 : row;
            const double *a = at(row), *b = at(next), dt = output.time_at(next) - output.time_at(row);
            const double t = output.within[k], s = output.fraction[k];
            const StepView load{loads[row], loads[next], dt};
            const auto pushed = [&](double until) -> Vec3 {
                const Vec3 impulse = load.force_integral3(at_load, at_load_curvature, until) +
                                     load.fraction(until) * vec(load.b + at_load_impulse);
                return body.inverse_mass * Vec3(impulse.x(), impulse.y(), 0.0);
            };
            const Vec3 v0 = vec(a + at_element_velocity), v1 = vec(b + at_element_velocity);
            const Vec3 p0 = vec(a + at_element_position), p1 = vec(b + at_element_position);
            const bool at_rest = v0.isZero(0.0) && v1.isZero(0.0);  // throughout the step
            element.velocity.push_back(
                at_rest || s == 1.0 ? v1 : Vec3(v0 + pushed(t) + s * (v1 - v0 - pushed(dt))));
            element.position.push_back(p0 + (p1 - p0) * (s * s * (3.0 - 2.0 * s)) +
                                       dt * s * (1.0 - s) * ((1.0 - s) * v0 - s * v1) + scene.base -
                                       height * Vec3::UnitZ());
            element.yaw_rate.push_back((1.0 - s) * a[at_element_spin] + s * b[at_element_spin]);
            const Eigen::Map<const Eigen::Vector4d> qa(a + at_element_orientation),
                qb(b + at_element_orientation);
            const Eigen::Vector4d q = (1.0 - s) * qa + s * (qa.dot(qb) < 0.0 ? -1.0 : 1.0) * qb;
            if (scene.tilts())
                element.axis.push_back(Quat(q[3], q[0], q[1], q[2]).normalized() * Vec3::UnitZ());
            const double angle = scene.tilts() ? 0.0 : 2.0 * std::atan2(q[2], q[3]);
            if (k > 0) yaw += std::remainder(angle - last_angle, 2.0 * std::numbers::pi);
            last_angle = angle;
            element.yaw.push_back(yaw);
        }
        history.moving_elements.push_back(std::move(element));
    }
}

}  // namespace birm3d
