// Evenly spaced output of the units, and what it is put together from.
#include <algorithm>
#include <cmath>
#include <utility>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"
#include "recorder_rows.hpp"

namespace birm3d {

namespace {

// A force that stops the vehicle within this time is large enough to judge the momentum balance by (s). No crash lasts
// as long, so that it counts only where next to nothing pushes.
constexpr double stopping_time = 1.0;

// Where the output instants fall in a record of rows of `width` numbers, of which a unit's begin at `offset`.
struct Steps {
    const Column& values;
    std::size_t width, offset;
    const Column& time;
    const std::vector<std::size_t>& step_of;

    double time_at(std::size_t row) const { return values[row * width + at_time]; }
    StepView view(std::size_t row) const {
        const double* a = values.data() + row * width + offset;
        return {a, a + width, time_at(row + 1) - time_at(row)};
    }
    // From the start of the step that holds instant `k`.
    double within_step(std::size_t k, double dt) const {
        return std::clamp(time[k] - time_at(step_of[k]), 0.0, dt);
    }
};

// No interval ends at the first instant: it shows the means of the one that begins there.
template <class T>
void show_first_mean(std::vector<T>& column) {
    if (column.size() > 1) column[0] = column[1];
}

}  // namespace

History Recorder::resample(const Scene& scene) const {
    History history;
    resample(scene, {}, history);
    return history;
}

void Recorder::resample(const Scene& scene, const Channels& wanted, History& history) const {
    const double interval = scene.settings.output_interval;
    const double end = values_[(rows() - 1) * width_ + at_time];
    // An end that misses an output instant by rounding only still has it.
    if (end > most_rows * interval)
        refuse("output_interval",
               "long enough for at most " + to_text(most_rows) + " rows, >= " + to_text(end / most_rows, 3) +
                   " s",
               interval);
    const auto count = static_cast<std::size_t>(std::floor(end / interval * (1.0 + 1e-12))) + 1;

    history.time.resize(count);
    for (std::size_t k = 0; k < count; ++k)
        history.time[k] = static_cast<double>(k) * interval;

    // The step that holds each output instant.
    std::vector<std::size_t> step_of(count, 0);
    for (std::size_t k = 0, row = 0; k < count; ++k) {
        while (row + 2 < rows() && values_[(row + 1) * width_ + at_time] <= history.time[k])
            ++row;
        step_of[k] = row;
    }

    history.towards = scene.towards();

    if (wanted.energies) resample_energies(step_of, history);
    history.units.resize(scene.vehicle->units.size());
    std::size_t offset = at_units;
    double worst = 0.0, largest = 0.0;
    for (std::size_t u = 0; u < history.units.size(); ++u) {
        const Unit& model = scene.vehicle->units[u];
        UnitHistory& unit = history.units[u];
        if (wanted.normal_force) resample_normal_force(step_of, offset, history.time, history.towards, unit);
        if (wanted.motion)
            resample_motion(step_of, offset, history.time, model, scene.settings.gravity, unit);
        if (wanted.motion)
            for (Vec3& position : unit.position)
                position += scene.base;
        if (wanted.contact_forces) resample_contact_forces(step_of, offset, history.time, unit);
        if (wanted.forces)
            largest = std::max(largest, resample_forces(step_of, offset, history.time, model,
                                                        scene.settings.gravity, unit, worst));
        offset += unit_width(model);
    }
    history.momentum_residual = largest > 0.0 ? worst / largest : 0.0;
    history.obstacles.clear();
    history.joints.clear();
    history.segments.clear();
    if (wanted.elements) resample_obstacles(scene, step_of, history);
    if (wanted.joints) resample_joints(scene, step_of, history);
    if (wanted.segments) resample_segments(scene, step_of, history);
}

void Recorder::resample_energies(const std::vector<std::size_t>& step_of, History& history) const {
    const std::size_t count = history.time.size();
    const Steps steps{values_, width_, at_energies, history.time, step_of};
    Column* const energies[] = {&history.kinetic,         &history.potential,        &history.stored,
                                &history.crushed,         &history.barrier_friction, &history.tire_friction,
                                &history.ground_friction, &history.impacts,          &history.joint_work,
                                &history.segment_friction};
    for (Column* column : energies)
        column->resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double* a = values_.data() + step_of[k] * width_ + at_energies;
        const double* b = a;
        double share = 1.0;
        if (rows() > 1) {
            const StepView step = steps.view(step_of[k]);
            b = step.b;
            share = step.share(steps.within_step(k, step.dt));
        }
        for (std::size_t e = 0; e < std::size(energies); ++e)
            (*energies[e])[k] = a[e] + share * (b[e] - a[e]);
    }
}

void Recorder::resample_normal_force(const std::vector<std::size_t>& step_of, std::size_t offset,
                                     const Column& time, const Vec3& towards, UnitHistory& unit) const {
    const Steps steps{values_, width_, offset, time, step_of};
    unit.barrier_normal_force.assign(time.size(), 0.0);
    Vec3 before_step = Vec3::Zero();  // impulse up to the start of the step that holds the instant
    Vec3 previous = Vec3::Zero();     // and up to the previous output instant
    std::size_t row = 0;
    for (std::size_t k = 0; k < time.size() && rows() > 1; ++k) {
        for (; row < step_of[k]; ++row) {
            const StepView whole = steps.view(row);
            before_step += whole.barrier_impulse(whole.dt);
        }
        const StepView step = steps.view(row);
        const Vec3 now = before_step + step.barrier_impulse(steps.within_step(k, step.dt));
        if (k > 0)
            unit.barrier_normal_force[k] = 1.0 / (time[k] - time[k - 1]) * (previous - now).dot(towards);
        previous = now;
    }
    show_first_mean(unit.barrier_normal_force);
}

void Recorder::resample_contact_forces(const std::vector<std::size_t>& step_of, std::size_t offset,
                                       const Column& time, UnitHistory& unit) const {
    const Steps steps{values_, width_, offset, time, step_of};
    unit.sum_of_contact_forces.assign(time.size(), 0.0);
    double before_step = 0.0, previous = 0.0;  // the same impulses
    std::size_t row = 0;
    for (std::size_t k = 0; k < time.size() && rows() > 1; ++k) {
        for (; row < step_of[k]; ++row) {
            const StepView whole = steps.view(row);
            before_step += whole.contact_impulse(whole.dt);
        }
        const StepView step = steps.view(row);
        const double now = before_step + step.contact_impulse(steps.within_step(k, step.dt));
        if (k > 0) unit.sum_of_contact_forces[k] = 1.0 / (time[k] - time[k - 1]) * (now - previous);
        previous = now;
    }
    show_first_mean(unit.sum_of_contact_forces);
}

void Recorder::resample_motion(const std::vector<std::size_t>& step_of, std::size_t offset,
                               const Column& time, const Unit& model, double gravity,
                               UnitHistory& unit) const {
    const Steps steps{values_, width_, offset, time, step_of};
    const std::size_t count = time.size();
    for (auto* column : {&unit.position, &unit.velocity, &unit.angular_velocity, &unit.acceleration})
        column->resize(count);
    unit.orientation.resize(count);
    unit.acceleration[0] = Vec3::Zero();
    if (rows() < 2) {
        const double* a = values_.data() + offset;
        unit.position[0] = vec(a + at_position);
        unit.orientation[0] = Quat(Eigen::Map<const Eigen::Vector4d>(a + at_orientation));
        unit.velocity[0] = vec(a + at_velocity);
        unit.angular_velocity[0] = vec(a + at_angular_velocity);
        return;
    }
    const Vec3 downwards(0.0, 0.0, -gravity);
    Impulses within;
    for (std::size_t k = 0; k < count; ++k) {
        const StepView step = steps.view(step_of[k]);
        const double t = steps.within_step(k, step.dt), s = step.share(t);
        const Vec3 a_velocity = vec(step.a + at_velocity), b_velocity = vec(step.b + at_velocity);
        unit.velocity[k] = b_velocity;
        if (s < 1.0) {
            within.set(step, t, model.wheels.size());
            unit.velocity[k] = a_velocity + model.body.inverse_mass * within.total() + t * downwards;
        }

        // Cubic Hermite for the path; the chord of the unit sphere for the small turn.
        const Vec3 a_position = vec(step.a + at_position), b_position = vec(step.b + at_position);
        unit.position[k] = a_position + (b_position - a_position) * (s * s * (3.0 - 2.0 * s)) +
                           step.dt * s * (1.0 - s) * ((1.0 - s) * a_velocity - s * b_velocity);
        const Eigen::Map<const Eigen::Vector4d> qa(step.a + at_orientation), qb(step.b + at_orientation);
        unit.orientation[k] =
            Quat(Eigen::Vector4d((1.0 - s) * qa + s * (qa.dot(qb) < 0.0 ? -1.0 : 1.0) * qb)).normalized();
        unit.angular_velocity[k] =
            (1.0 - s) * vec(step.a + at_angular_velocity) + s * vec(step.b + at_angular_velocity);
        if (k == 0) continue;
        const double per = 1.0 / (time[k] - time[k - 1]);
        const Vec3 acceleration = per * (unit.velocity[k] - unit.velocity[k - 1]);
        unit.acceleration[k] = unit.orientation[k].conjugate() * acceleration;
    }
    if (count > 1)
        unit.acceleration[0] = unit.orientation[0].conjugate() * (unit.orientation[1] * unit.acceleration[1]);
}

// Needs the motion. Returns the largest force of any row, at least that which stops the unit in `stopping_time`; and in `worst` that by which m a misses the sum of forces (N).
double Recorder::resample_forces(const std::vector<std::size_t>& step_of, std::size_t offset,
                                 const Column& time, const Unit& model, double gravity, UnitHistory& unit,
                                 double& worst) const {
    const Steps steps{values_, width_, offset, time, step_of};
    const std::size_t wheels = model.wheels.size();
    const Vec3 weight = model.body.mass * Vec3(0.0, 0.0, -gravity);
    const auto columns = {&unit.barrier_force, &unit.ground_force, &unit.tire_friction_force,
                          &unit.joint_force};
    for (auto* column : columns)
        column->assign(time.size(), Vec3::Zero());
    unit.tire_reaction.assign(wheels, Column(time.size(), 0.0));

    Impulses before_step;  // up to the start of the step that holds the instant
    before_step.tire.assign(wheels, 0.0);
    Impulses previous = before_step;  // up to the previous output instant
    Impulses now;
    const double start_speed =
        std::max(vec(values_.data() + offset + at_velocity).norm(), tolerance::slowest_reference_speed);
    double largest = model.body.mass * start_speed / stopping_time;
    std::size_t row = 0;
    for (std::size_t k = 0; k < time.size() && rows() > 1; ++k) {
        for (; row < step_of[k]; ++row) {
            const StepView whole = steps.view(row);
            now.set(whole, whole.dt, wheels);
            before_step += now;
        }
        const StepView step = steps.view(row);
        now.set(step, steps.within_step(k, step.dt), wheels);
        now += before_step;
        if (k > 0) {
            const double per = 1.0 / (time[k] - time[k - 1]);
            unit.barrier_force[k] = per * (now.barrier - previous.barrier);
            unit.ground_force[k] = per * (now.ground - previous.ground);
            unit.tire_friction_force[k] = per * (now.tire_friction - previous.tire_friction);
            unit.joint_force[k] = per * (now.joints - previous.joints);
            Vec3 force = unit.barrier_force[k] + unit.ground_force[k] + unit.tire_friction_force[k] +
                         unit.joint_force[k] + weight;
            for (std::size_t w = 0; w < wheels; ++w) {
                unit.tire_reaction[w][k] = per * (now.tire[w] - previous.tire[w]);
                force.z() += unit.tire_reaction[w][k];
            }
            const Vec3 acceleration = per * (unit.velocity[k] - unit.velocity[k - 1]);
            worst = std::max(worst, (model.body.mass * acceleration - force).norm());
            largest = std::max({largest, force.norm(), unit.barrier_force[k].norm(), weight.norm()});
        }
        std::swap(previous, now);
    }
    for (auto* column : columns)
        show_first_mean(*column);
    for (Column& wheel : unit.tire_reaction)
        show_first_mean(wheel);
    return largest;
}

}  // namespace birm3d
