#include "birm3d/sim/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "birm3d/base/rotation.hpp"
#include "birm3d/kernels/integrate.hpp"

namespace birm3d {

namespace {

// Where the numbers of a row stand. Energies and bodies at the end of the step, impulses within it.
enum RowOffset : std::size_t { at_time = 0, at_energies = 1, at_units = 11 };
enum UnitOffset : std::size_t {
    at_position = 0,
    at_orientation = 3,  // x, y, z, w
    at_velocity = 7,
    at_angular_velocity = 10,  // body axes
    at_barrier_force = 13,     // contact and friction, world axes
    at_normal_force = 16,
    at_tire_friction = 17,  // impulse
    at_barrier_impulse = 20,
    at_normal_impulse = 23,
    at_barrier_bend = 24,  // what the higher order adds to the straight course of the force: impulse
    at_normal_bend = 27,
    at_ground_force = 28,  // of the ground on the skin: the same three as of the barrier
    at_ground_impulse = 31,
    at_ground_bend = 34,
    at_joint_impulse = 37,
    at_tire_impulses = 40
};
// And in the numbers of an obstacle: force and torque on it, about its own point, world axes.
enum ObstacleOffset : std::size_t {
    at_load = 0,
    at_load_impulse = 6,
    at_load_bend = 12,
    obstacle_width = 18
};
// Behind the units: for each joint force and moment impulse.
constexpr std::size_t joint_width = 6;
// Behind the joints: for each free-standing segment its motion.
enum SegmentOffset : std::size_t {
    at_segment_position = 0,
    at_segment_orientation = 3,
    at_segment_velocity = 7,
    at_segment_spin = 10,
    segment_width = 11
};

std::size_t unit_width(const Unit& unit) {
    return at_tire_impulses + unit.wheels.size();
}

Vec3 vec(const double* p) {
    return {p[0], p[1], p[2]};
}

// One step of one unit: its two rows, and the running integrals up to its start.
struct StepView {
    const double* a;  // unit part of the row at the start
    const double* b;  // and at the end
    double dt;

    // How much of the step has passed at `t` from its start; an impact's step has no length and is over at once.
    double share(double t) const { return dt > 0.0 ? t / dt : 1.0; }
    // Integral from the start of the step to `t` of a force with end values a[i], b[i] (N s).
    // With it the bend of a parabola that meets the end values, given by its impulse b[bend] over the step.
    double force_integral(std::size_t i, std::size_t bend, double t) const {
        const double s = share(t);
        return t * (a[i] + 0.5 * s * (b[i] - a[i])) + s * s * (3.0 - 2.0 * s) * b[bend];
    }
    Vec3 force_integral3(std::size_t i, std::size_t bend, double t) const {
        return {force_integral(i, bend, t), force_integral(i + 1, bend + 1, t),
                force_integral(i + 2, bend + 2, t)};
    }
    double impulse(std::size_t i, double t) const { return share(t) * b[i]; }
};

// Impulses since the start of the run (N s).
struct Impulses {
    Vec3 barrier = Vec3::Zero(), ground = Vec3::Zero();
    double barrier_normal = 0.0;
    Vec3 tire_friction = Vec3::Zero();
    Vec3 joints = Vec3::Zero();
    Column tire;

    static Impulses within(const StepView& step, double t, std::size_t wheels) {
        Impulses sum;
        sum.barrier = step.force_integral3(at_barrier_force, at_barrier_bend, t) +
                      step.share(t) * vec(step.b + at_barrier_impulse);
        sum.ground = step.force_integral3(at_ground_force, at_ground_bend, t) +
                     step.share(t) * vec(step.b + at_ground_impulse);
        sum.barrier_normal =
            step.force_integral(at_normal_force, at_normal_bend, t) + step.impulse(at_normal_impulse, t);
        sum.tire_friction = step.share(t) * vec(step.b + at_tire_friction);
        sum.joints = step.share(t) * vec(step.b + at_joint_impulse);
        for (std::size_t w = 0; w < wheels; ++w)
            sum.tire.push_back(step.impulse(at_tire_impulses + w, t));
        return sum;
    }
    Impulses& operator+=(const Impulses& other) {
        barrier += other.barrier;
        ground += other.ground;
        barrier_normal += other.barrier_normal;
        tire_friction += other.tire_friction;
        joints += other.joints;
        tire.resize(other.tire.size(), 0.0);
        for (std::size_t w = 0; w < tire.size(); ++w)
            tire[w] += other.tire[w];
        return *this;
    }
    Vec3 total() const {
        Vec3 sum = barrier + ground + tire_friction + joints;
        for (const double j : tire)
            sum.z() += j;
        return sum;
    }
};

std::vector<BodyState> bodies_of(const State& state) {
    std::vector<BodyState> bodies;
    for (const UnitState& unit : state.units)
        bodies.push_back(unit.body);
    return bodies;
}

}  // namespace

Recorder::Recorder(const Scene& scene, const State& start) : width_(at_units) {
    std::vector<ContactImpulses> none;
    for (const Unit& unit : scene.vehicle->units) {
        width_ += unit_width(unit);
        none.emplace_back(unit.wheels.size());
    }
    width_ += joint_width * scene.vehicle->joints.size() + segment_width * start.segments.size();
    values_.reserve(512 * width_);
    add_row(scene, start.time, start.energies, bodies_of(start),
            {start.units, start.segments, none, std::vector<Wrench>(scene.vehicle->joints.size()), false});
}

void Recorder::add(const Scene& scene, const Trial& accepted) {
    const State& state = accepted.state;
    if (accepted.at_start.happened) {
        // The forces of that instant are those of the row before.
        const std::size_t before = values_.size() - width_;
        const std::size_t last = rows() - 1;
        add_row(scene, values_[before + at_time], accepted.at_start.energies, accepted.at_start.bodies,
                {state.units, accepted.at_start.segments, accepted.at_start.impulses,
                 accepted.at_start.joint_impulses, false});
        const double* from = values_.data() + before + at_units;
        double* to = values_.data() + values_.size() - width_ + at_units;
        for (const Unit& unit : scene.vehicle->units) {
            std::copy(from + at_barrier_force, from + at_tire_friction, to + at_barrier_force);
            std::copy(from + at_ground_force, from + at_ground_impulse, to + at_ground_force);
            from += unit_width(unit), to += unit_width(unit);
        }
        for (ObstacleRow& row : obstacles_)
            if (row.row == last + 1) std::fill_n(row.values.begin() + at_load, 6, 0.0);
        for (std::size_t i = 0, count = obstacles_.size(); i < count; ++i)
            if (obstacles_[i].row == last)
                std::copy_n(obstacles_[i].values.begin() + at_load, 6,
                            obstacle_row(last + 1, obstacles_[i].obstacle).values.begin() + at_load);
    }
    const std::vector<BodyState> bodies = bodies_of(state);
    const Impact& end = accepted.at_end;
    add_row(scene, state.time, end.happened ? end.energies : state.energies,
            end.happened ? end.bodies : bodies,
            {state.units, end.happened ? end.segments : state.segments, accepted.impulses,
             accepted.joint_impulses, true});
    if (end.happened)
        add_row(scene, state.time, state.energies, bodies,
                {state.units, state.segments, end.impulses, end.joint_impulses, false});
}

Recorder::ObstacleRow& Recorder::obstacle_row(std::size_t row, std::size_t obstacle) {
    for (auto known = obstacles_.rbegin(); known != obstacles_.rend() && known->row == row; ++known)
        if (known->obstacle == obstacle) return *known;
    obstacles_.push_back({row, obstacle, {}});
    return obstacles_.back();
}

void Recorder::add_row(const Scene& scene, double time, const Energies& e,
                       const std::vector<BodyState>& bodies, const Loads& loads) {
    const std::size_t index = rows();
    const std::size_t begin = values_.size();
    values_.resize(begin + width_);
    double* row = values_.data() + begin;
    const auto put = [](double* to, const Vec3& v) { std::copy_n(v.data(), 3, to); };
    const auto add_to = [](double* to, const Vec3& v) {
        for (int i = 0; i < 3; ++i)
            to[i] += v[i];
    };
    row[at_time] = time;
    const std::array energies = {e.kinetic,          e.potential,       e.stored,          e.crushed,
                                 e.barrier_friction, e.tire_friction,   e.ground_friction, e.impacts,
                                 e.joints,           e.segment_friction};
    std::copy(energies.begin(), energies.end(), row + at_energies);
    row += at_units;
    for (std::size_t u = 0; u < bodies.size(); ++u) {
        const BodyState& body = bodies[u];
        const Unit& model = scene.vehicle->units[u];
        const ContactImpulses& impulses = loads.impulses[u];
        put(row + at_position, body.position);
        std::copy_n(body.orientation.coeffs().data(), 4, row + at_orientation);
        put(row + at_velocity, body.velocity);
        put(row + at_angular_velocity, body.orientation.conjugate() * angular_velocity(model.body, body));
        put(row + at_tire_friction, impulses.tire_friction);
        put(row + at_joint_impulse, impulses.joints);
        row[at_normal_impulse] = impulses.barrier_normal;
        for (const Touch& touch : loads.units[u].touches) {
            const bool ground = touch.obstacle == scene.ground;
            const Load& now = touch.course.now;
            add_to(row + (ground ? at_ground_force : at_barrier_force), now.wrench.force);
            if (!ground) row[at_normal_force] += touch.normal_force;
            const Load bend = loads.bent ? touch.extra.correction : Load{};
            add_to(row + (ground ? at_ground_bend : at_barrier_bend), bend.wrench.force);
            if (ground) continue;
            row[at_normal_bend] += bend.normal_force;
            double* on = obstacle_row(index, touch.obstacle).values.data();
            add_to(on + at_load, -now.wrench.force);
            add_to(on + at_load + 3, now.reaction_torque);
            add_to(on + at_load_bend, -bend.wrench.force);
            add_to(on + at_load_bend + 3, bend.reaction_torque);
        }
        for (const ObstacleImpulse& of : impulses.obstacles) {
            const bool ground = of.obstacle == scene.ground;
            add_to(row + (ground ? at_ground_impulse : at_barrier_impulse), of.impulse);
            if (ground) continue;
            double* on = obstacle_row(index, of.obstacle).values.data();
            add_to(on + at_load_impulse, -of.impulse);
            add_to(on + at_load_impulse + 3, of.torque);
        }
        std::copy(impulses.tire.begin(), impulses.tire.end(), row + at_tire_impulses);
        row += unit_width(model);
    }
    for (const Wrench& joint : loads.joint_impulses) {
        put(row, joint.force);
        put(row + 3, joint.torque);
        row += joint_width;
    }
    for (std::size_t i = 0; i < loads.segments.size(); ++i) {
        const BodyState& body = loads.segments[i];
        put(row + at_segment_position, body.position);
        std::copy_n(body.orientation.coeffs().data(), 4, row + at_segment_orientation);
        put(row + at_segment_velocity, body.velocity);
        row[at_segment_spin] = angular_velocity(scene.barrier->segments[i].body, body).z();
        row += segment_width;
    }
}

void Recorder::resample_joints(const Scene& scene, const std::vector<std::size_t>& step_of,
                               History& history) const {
    const std::vector<Joint>& joints = scene.vehicle->joints;
    const std::size_t first = width_ - segment_width * scene.free_segments() - joint_width * joints.size(),
                      count = history.time.size();
    for (std::size_t j = 0; j < joints.size(); ++j) {
        JointHistory joint;
        joint.force.assign(count, Vec3::Zero());
        joint.moment.assign(count, Vec3::Zero());
        const auto& leading = history.units[joints[j].leading].orientation;
        const auto& trailing = history.units[joints[j].trailing].orientation;
        for (std::size_t k = 0; k < count; ++k)
            joint.angles.push_back(joint_angles(leading[k], trailing[k]));

        const auto row_at = [&](std::size_t row) { return values_.data() + row * width_; };
        const auto add = [&](std::size_t row, double share, Wrench& sum) {
            const double* impulse = row_at(row + 1) + first + j * joint_width;
            sum += {share * vec(impulse), share * vec(impulse + 3)};
        };
        Wrench before_step, previous;
        std::size_t row = 0;
        for (std::size_t k = 0; k < count && rows() > 1; ++k) {
            for (; row < step_of[k]; ++row)
                add(row, 1.0, before_step);
            const double dt = row_at(row + 1)[at_time] - row_at(row)[at_time];
            const double t = std::clamp(history.time[k] - row_at(row)[at_time], 0.0, dt);
            Wrench now = before_step;
            add(row, dt > 0.0 ? t / dt : 1.0, now);
            if (k > 0) {
                const double per = 1.0 / (history.time[k] - history.time[k - 1]);
                joint.force[k] = per * (now.force - previous.force);
                joint.moment[k] = per * (now.torque - previous.torque);
            }
            previous = now;
        }
        if (count > 1) joint.force[0] = joint.force[1], joint.moment[0] = joint.moment[1];
        history.joints.push_back(std::move(joint));
    }
}

History Recorder::resample(const Scene& scene) const {
    History history;
    const double interval = scene.settings.output_interval;
    const double end = values_[(rows() - 1) * width_ + at_time];
    // An end that misses an output instant by rounding only still has it.
    const auto count = static_cast<std::size_t>(std::floor(end / interval * (1.0 + 1e-12))) + 1;
    const auto row_at = [&](std::size_t row) { return values_.data() + row * width_; };

    history.time.resize(count);
    for (std::size_t k = 0; k < count; ++k)
        history.time[k] = static_cast<double>(k) * interval;

    // The step that holds each output instant.
    std::vector<std::size_t> step_of(count, 0);
    for (std::size_t k = 0, row = 0; k < count; ++k) {
        while (row + 2 < rows() && row_at(row + 1)[at_time] <= history.time[k])
            ++row;
        step_of[k] = row;
    }
    const auto within_step = [&](std::size_t k) {
        const double dt = row_at(step_of[k] + 1)[at_time] - row_at(step_of[k])[at_time];
        return std::clamp(history.time[k] - row_at(step_of[k])[at_time], 0.0, dt);
    };
    const bool still = rows() < 2;

    Column* const energies[] = {&history.kinetic,         &history.potential,        &history.stored,
                                &history.crushed,         &history.barrier_friction, &history.tire_friction,
                                &history.ground_friction, &history.impacts,          &history.joint_work,
                                &history.segment_friction};
    for (std::size_t e = 0; e < std::size(energies); ++e) {
        energies[e]->resize(count);
        for (std::size_t k = 0; k < count; ++k) {
            const double* a = row_at(step_of[k]);
            const double* b = still ? a : a + width_;
            const double dt = b[at_time] - a[at_time];
            const double share = dt > 0.0 ? within_step(k) / dt : 1.0;
            (*energies[e])[k] = a[at_energies + e] + share * (b[at_energies + e] - a[at_energies + e]);
        }
    }

    std::size_t offset = at_units;
    double worst = 0.0, largest = 0.0;
    for (const Unit& model : scene.vehicle->units) {
        const std::size_t wheels = model.wheels.size();
        const Vec3 gravity(0.0, 0.0, -scene.settings.gravity);
        UnitHistory unit;
        unit.tire_reaction.assign(wheels, Column(count, 0.0));
        unit.barrier_normal_force.resize(count);
        for (auto* column :
             {&unit.position, &unit.velocity, &unit.angular_velocity, &unit.acceleration, &unit.barrier_force,
              &unit.ground_force, &unit.tire_friction_force, &unit.joint_force})
            column->resize(count);
        unit.orientation.resize(count);

        Impulses before_step;  // up to the start of the step that holds the instant
        before_step.tire.assign(wheels, 0.0);
        Impulses previous = before_step;  // up to the previous output instant
        std::size_t row = 0;
        for (std::size_t k = 0; k < count; ++k) {
            if (still) {
                const double* a = row_at(0) + offset;
                unit.position[k] = vec(a + at_position);
                unit.orientation[k] = Quat(Eigen::Map<const Eigen::Vector4d>(a + at_orientation));
                unit.velocity[k] = vec(a + at_velocity);
                unit.angular_velocity[k] = vec(a + at_angular_velocity);
                unit.acceleration[k] = unit.barrier_force[k] = unit.ground_force[k] =
                    unit.tire_friction_force[k] = unit.joint_force[k] = Vec3::Zero();
                unit.barrier_normal_force[k] = 0.0;
                continue;
            }
            const auto view = [&](std::size_t r) {
                return StepView{row_at(r) + offset, row_at(r + 1) + offset,
                                row_at(r + 1)[at_time] - row_at(r)[at_time]};
            };
            for (; row < step_of[k]; ++row)
                before_step += Impulses::within(view(row), view(row).dt, wheels);
            const StepView step = view(row);
            const double t = within_step(k);
            const double s = step.share(t);

            Impulses now = Impulses::within(step, t, wheels);
            const Vec3 a_velocity = vec(step.a + at_velocity), b_velocity = vec(step.b + at_velocity);
            unit.velocity[k] =
                s < 1.0 ? Vec3(a_velocity + model.body.inverse_mass * now.total() + t * gravity) : b_velocity;
            now += before_step;

            // Cubic Hermite for the path; the chord of the unit sphere for the small turn.
            const Vec3 a_position = vec(step.a + at_position), b_position = vec(step.b + at_position);
            unit.position[k] = a_position + (b_position - a_position) * (s * s * (3.0 - 2.0 * s)) +
                               step.dt * s * (1.0 - s) * ((1.0 - s) * a_velocity - s * b_velocity);
            const Eigen::Map<const Eigen::Vector4d> qa(step.a + at_orientation), qb(step.b + at_orientation);
            unit.orientation[k] =
                Quat(Eigen::Vector4d((1.0 - s) * qa + s * (qa.dot(qb) < 0.0 ? -1.0 : 1.0) * qb)).normalized();
            unit.angular_velocity[k] =
                (1.0 - s) * vec(step.a + at_angular_velocity) + s * vec(step.b + at_angular_velocity);

            if (k > 0) {
                const double per = 1.0 / (history.time[k] - history.time[k - 1]);
                unit.barrier_force[k] = per * (now.barrier - previous.barrier);
                unit.barrier_normal_force[k] = per * (now.barrier_normal - previous.barrier_normal);
                unit.ground_force[k] = per * (now.ground - previous.ground);
                unit.tire_friction_force[k] = per * (now.tire_friction - previous.tire_friction);
                unit.joint_force[k] = per * (now.joints - previous.joints);
                Vec3 force = unit.barrier_force[k] + unit.ground_force[k] + unit.tire_friction_force[k] +
                             unit.joint_force[k] + model.body.mass * gravity;
                for (std::size_t w = 0; w < wheels; ++w) {
                    unit.tire_reaction[w][k] = per * (now.tire[w] - previous.tire[w]);
                    force.z() += unit.tire_reaction[w][k];
                }
                const Vec3 acceleration = per * (unit.velocity[k] - unit.velocity[k - 1]);
                worst = std::max(worst, (model.body.mass * acceleration - force).norm());
                largest = std::max(
                    {largest, force.norm(), unit.barrier_force[k].norm(), model.body.mass * gravity.norm()});
                unit.acceleration[k] = unit.orientation[k].conjugate() * acceleration;
            }
            previous = now;
        }
        if (count > 1) {
            // No interval ends at the first instant: it shows the means of the one that begins there.
            unit.acceleration[0] =
                unit.orientation[0].conjugate() * (unit.orientation[1] * unit.acceleration[1]);
            unit.barrier_force[0] = unit.barrier_force[1];
            unit.barrier_normal_force[0] = unit.barrier_normal_force[1];
            unit.ground_force[0] = unit.ground_force[1];
            unit.tire_friction_force[0] = unit.tire_friction_force[1];
            unit.joint_force[0] = unit.joint_force[1];
            for (Column& wheel : unit.tire_reaction)
                wheel[0] = wheel[1];
        }
        history.units.push_back(std::move(unit));
        offset += unit_width(model);
    }
    resample_obstacles(step_of, history);
    resample_joints(scene, step_of, history);
    resample_segments(scene, step_of, history);
    history.momentum_residual = largest > 0.0 ? worst / largest : 0.0;
    return history;
}

// Forces and torques on the obstacles that were touched, as means over the output intervals.
void Recorder::resample_obstacles(const std::vector<std::size_t>& step_of, History& history) const {
    std::map<std::size_t, std::vector<const ObstacleRow*>>
        touched;  // obstacle -> (rows), null where untouched
    for (const ObstacleRow& row : obstacles_) {
        auto& rows_of = touched[row.obstacle];
        rows_of.resize(rows(), nullptr);
        rows_of[row.row] = &row;
    }
    static constexpr std::array<double, obstacle_width> nothing{};
    const auto time_at = [&](std::size_t row) { return values_[row * width_ + at_time]; };
    for (const auto& [obstacle, rows_of] : touched) {
        const auto view = [&](std::size_t r) {
            const auto values = [&](std::size_t i) {
                return rows_of[i] ? rows_of[i]->values.data() : nothing.data();
            };
            return StepView{values(r), values(r + 1), time_at(r + 1) - time_at(r)};
        };
        const auto within = [](const StepView& step, double t) {
            std::array<double, 6> sum;
            for (std::size_t i = 0; i < 6; ++i)
                sum[i] = step.force_integral(at_load + i, at_load_bend + i, t) +
                         step.impulse(at_load_impulse + i, t);
            return sum;
        };
        ObstacleHistory of{obstacle, {}, {}};
        const std::size_t count = history.time.size();
        of.force.assign(count, Vec3::Zero());
        of.moment.assign(count, Vec3::Zero());
        std::array<double, 6> before_step{}, previous{};
        std::size_t row = 0;
        for (std::size_t k = 0; k < count && rows() > 1; ++k) {
            for (; row < step_of[k]; ++row) {
                const std::array<double, 6> whole = within(view(row), view(row).dt);
                for (std::size_t i = 0; i < 6; ++i)
                    before_step[i] += whole[i];
            }
            const StepView step = view(row);
            std::array<double, 6> now =
                within(step, std::clamp(history.time[k] - time_at(row), 0.0, step.dt));
            std::array<double, 6> mean{};
            for (std::size_t i = 0; i < 6; ++i) {
                now[i] += before_step[i];
                if (k > 0) mean[i] = (now[i] - previous[i]) / (history.time[k] - history.time[k - 1]);
            }
            of.force[k] = vec(mean.data());
            of.moment[k] = vec(mean.data() + 3);
            previous = now;
        }
        if (count > 1) of.force[0] = of.force[1], of.moment[0] = of.moment[1];
        history.obstacles.push_back(std::move(of));
    }
}

// Between rows a segment moves by what the vehicle does to it, as the record has it; what the ground and the pins do
// within the step, the rest of its change of velocity, is spread evenly. So the momentum of all bodies adds up at every
// instant.
void Recorder::resample_segments(const Scene& scene, const std::vector<std::size_t>& step_of,
                                 History& history) const {
    const std::size_t segments = scene.free_segments(), count = history.time.size();
    const std::size_t first = width_ - segment_width * segments;
    static constexpr std::array<double, obstacle_width> nothing{};
    for (std::size_t i = 0; i < segments; ++i) {
        const RigidBody& body = scene.barrier->segments[i].body;
        const double height = scene.barrier->segments[i].mass_center_height;
        std::vector<const double*> loads(rows(), nothing.data());
        for (const ObstacleRow& row : obstacles_)
            if (row.obstacle == i) loads[row.row] = row.values.data();
        const auto at = [&](std::size_t row) {
            return values_.data() + row * width_ + first + i * segment_width;
        };
        const auto time_at = [&](std::size_t row) { return values_[row * width_ + at_time]; };

        SegmentHistory segment;
        double yaw = 0.0, last_angle = 0.0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t row = step_of[k], next = rows() > 1 ? row + 1 : row;
            const double *a = at(row), *b = at(next), dt = time_at(next) - time_at(row);
            const double t = std::clamp(history.time[k] - time_at(row), 0.0, dt), s = dt > 0.0 ? t / dt : 1.0;
            const StepView load{loads[row], loads[next], dt};
            const auto pushed = [&](double until) -> Vec3 {
                const Vec3 impulse = load.force_integral3(at_load, at_load_bend, until) +
                                     load.share(until) * vec(load.b + at_load_impulse);
                return body.inverse_mass * Vec3(impulse.x(), impulse.y(), 0.0);
            };
            const Vec3 v0 = vec(a + at_segment_velocity), v1 = vec(b + at_segment_velocity);
            const Vec3 p0 = vec(a + at_segment_position), p1 = vec(b + at_segment_position);
            const bool held = v0.isZero(0.0) && v1.isZero(0.0);  // throughout the step
            segment.velocity.push_back(held || s == 1.0 ? v1
                                                        : Vec3(v0 + pushed(t) + s * (v1 - v0 - pushed(dt))));
            segment.position.push_back(p0 + (p1 - p0) * (s * s * (3.0 - 2.0 * s)) +
                                       dt * s * (1.0 - s) * ((1.0 - s) * v0 - s * v1) -
                                       height * Vec3::UnitZ());
            segment.yaw_rate.push_back((1.0 - s) * a[at_segment_spin] + s * b[at_segment_spin]);
            const Eigen::Map<const Eigen::Vector4d> qa(a + at_segment_orientation),
                qb(b + at_segment_orientation);
            const Eigen::Vector4d q = (1.0 - s) * qa + s * (qa.dot(qb) < 0.0 ? -1.0 : 1.0) * qb;
            const double angle = 2.0 * std::atan2(q[2], q[3]);
            if (k > 0) yaw += std::remainder(angle - last_angle, 2.0 * std::numbers::pi);
            last_angle = angle;
            segment.yaw.push_back(yaw);
        }
        history.segments.push_back(std::move(segment));
    }
}

}  // namespace birm3d
