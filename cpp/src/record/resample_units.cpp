// Evenly spaced output of the units.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/wide_loops.hpp"
#include "birm3d/base/tolerances.hpp"
#include "record/greatest.hpp"
#include "record/span_motion.hpp"

namespace birm3d {

namespace {

// The momentum balance is relative to the largest force, but at least to the force that stops the vehicle in this
// time (s). Forces of a crash are larger.
constexpr double stopping_time = 1.0;

// The rows of one unit, span by span.
class UnitRows {
  public:
    UnitRows(const OutputInstants& output, std::size_t offset, const Unit& model, double gravity,
             const Channels& wanted, UnitHistory& unit)
        : output_(output),
          offset_(offset),
          model_(model),
          down_(0.0, 0.0, -gravity),
          wanted_(wanted),
          unit_(unit),
          motion_(wanted.motion),
          forces_(wanted.forces),
          momentum_(wanted.momentum && wanted.motion),
          pushes_{pushed(at_ground_force, 9), pushed(at_tire_friction, 3), pushed(at_joint_impulse, 3)} {
        const double* start = output.values.data() + offset;
        const double speed = std::max(vec(start + at_velocity).norm(), tolerance::slowest_reference_speed);
        largest_ = model.body.mass * speed / stopping_time;
        now_.tire.resize(model.wheels.size());
        before_step_.tire.assign(model.wheels.size(), 0.0);
        previous_ = before_step_;
    }

    void run(const Vec3& towards) {
        make_columns();
        std::size_t row = 0;
        for (const Span& span : output_.span) {
            for (; row < span.row; ++row)
                pass(output_.view(row, offset_));
            const StepView step = output_.view(row, offset_);
            if (motion_ || forces_ || momentum_)
                now_.set(output_, span, step, pushes_);
            else
                SpanImpulses::integrate(output_, span, step, at_barrier_force, at_barrier_curvature,
                                        at_barrier_impulse, now_.barrier);
            if (motion_) add_motion(span, step);
            if (forces_ || momentum_)
                now_.add(before_step_, span, pushes_);
            else if (wanted_.normal_force)
                now_.barrier.add(before_step_.barrier, span);
            if (wanted_.normal_force || momentum_)
                means(span, now_.barrier, previous_.barrier, barrier_mean_);
            if (wanted_.normal_force) add_normal_force(span, towards);
            if (forces_) add_forces(span);
            if (momentum_) look_at_momentum(span);
            keep_last(span);
        }
        finish();
    }
    // Largest force of any row, at least the force that stops the unit in `stopping_time`; and the largest difference
    // between m a and the sum of forces (N).
    double largest() const { return largest_; }
    double worst() const { return worst_; }

  private:
    // Is any of `count` numbers of the unit other than zero, in any row?
    bool pushed(std::size_t first, std::size_t count) const {
        const double* row = output_.values.data() + offset_ + first;
        for (std::size_t r = 0; r < output_.rows; ++r, row += output_.width)
            if (std::any_of(row, row + count, [](double number) { return number != 0.0; })) return true;
        return false;
    }

    void make_columns() {
        const std::size_t count = output_.time.size();
        if (wanted_.normal_force) unit_.barrier_normal_force.assign(count, 0.0);
        if (motion_) {
            for (auto* column : {&unit_.position, &unit_.velocity, &unit_.acceleration})
                column->resize(count);
            unit_.orientation.resize(count);
            if (wanted_.angular_velocity) unit_.angular_velocity.resize(count);
            unit_.acceleration[0] = Vec3::Zero();
            if (output_.rows < 2) rest();
        }
        if (!forces_) return;
        for (auto* column : force_columns())
            column->assign(count, Vec3::Zero());
        unit_.tire_reaction.assign(model_.wheels.size(), Column(count, 0.0));
    }
    std::array<std::vector<Vec3>*, 4> force_columns() {
        return {&unit_.barrier_force, &unit_.ground_force, &unit_.tire_friction_force, &unit_.joint_force};
    }

    // Of a record without a step.
    void rest() {
        const double* a = output_.values.data() + offset_;
        std::fill(unit_.position.begin(), unit_.position.end(), vec(a + at_position));
        std::fill(unit_.orientation.begin(), unit_.orientation.end(),
                  Quat(Eigen::Map<const Eigen::Vector4d>(a + at_orientation)));
        std::fill(unit_.velocity.begin(), unit_.velocity.end(), vec(a + at_velocity));
        std::fill(unit_.acceleration.begin(), unit_.acceleration.end(), Vec3::Zero());
        if (wanted_.angular_velocity)
            std::fill(unit_.angular_velocity.begin(), unit_.angular_velocity.end(),
                      vec(a + at_angular_velocity));
    }

    // Over a whole step.
    void pass(const StepView& whole) {
        if (forces_ || momentum_) {
            passed_.set(whole, whole.dt, model_.wheels.size());
            before_step_ += passed_;
        } else if (wanted_.normal_force) {
            before_step_.barrier += whole.barrier_impulse(whole.dt);
        }
    }

    void add_motion(const Span& span, const StepView& step) {
        const std::size_t n = span.size(), first = span.first;
        SpanVectors total;
        total.set(now_.barrier, span);
        for_others([&](const SpanVectors& impulse, const Vec3&) { total.add(impulse, span); });
        for (const SpanColumn& tire : now_.tire)
            for (std::size_t i = 0; i < span.filled(); ++i)
                total.z[i] += tire[i];
        moved_.set_velocity(output_, span, step, total, model_.body.inverse_mass, down_);
        moved_.set_place(output_, span, step);
        moved_.set_acceleration(output_, span, first > 0 ? unit_.velocity[first - 1] : moved_.velocity.at(0));
        for (std::size_t i = 0; i < n; ++i) {
            unit_.position[first + i] = moved_.position.at(i);
            unit_.velocity[first + i] = moved_.velocity.at(i);
            unit_.orientation[first + i] = moved_.orientation_at(i);
            unit_.acceleration[first + i] = moved_.body_acceleration.at(i);
        }
        if (!wanted_.angular_velocity) return;
        for (std::size_t k = first; k < span.end; ++k)
            unit_.angular_velocity[k] = (1.0 - output_.fraction[k]) * vec(step.a + at_angular_velocity) +
                                        output_.fraction[k] * vec(step.b + at_angular_velocity);
    }
    // What pushes beside the barrier and the wheels' normal forces: impulses at the instants and at the one before.
    template <class Use>
    void for_others(const Use& use) const {
        if (pushes_.ground) use(now_.ground, previous_.ground);
        if (pushes_.tire_friction) use(now_.tire_friction, previous_.tire_friction);
        if (pushes_.joints) use(now_.joints, previous_.joints);
    }

    void add_normal_force(const Span& span, const Vec3& towards) {
        double* to = unit_.barrier_normal_force.data() + span.first;
        BIRM3D_INDEPENDENT
        for (std::size_t i = span.first == 0 ? 1 : 0, n = span.size(); i < n; ++i)
            to[i] = 0.0 - (barrier_mean_.x[i] * towards.x() + barrier_mean_.y[i] * towards.y() +
                           barrier_mean_.z[i] * towards.z());
    }

    void add_forces(const Span& span) {
        const auto add = [&](const SpanVectors& impulse, Vec3 previous, std::vector<Vec3>& to) {
            for (std::size_t k = span.first; k < span.end; ++k) {
                const Vec3 now = impulse.at(k - span.first);
                if (k > 0) to[k] = output_.per[k] * (now - previous);
                previous = now;
            }
        };
        add(now_.barrier, previous_.barrier, unit_.barrier_force);
        add(now_.ground, previous_.ground, unit_.ground_force);
        add(now_.tire_friction, previous_.tire_friction, unit_.tire_friction_force);
        add(now_.joints, previous_.joints, unit_.joint_force);
        for (std::size_t w = 0; w < now_.tire.size(); ++w) {
            double previous = previous_.tire[w];
            for (std::size_t k = span.first; k < span.end; ++k) {
                const double now = now_.tire[w][k - span.first];
                if (k > 0) unit_.tire_reaction[w][k] = output_.per[k] * (now - previous);
                previous = now;
            }
        }
    }

    // Means over the intervals that end at the instants.
    void means(const Span& span, const SpanVectors& impulse, const Vec3& previous, SpanVectors& to) const {
        output_.means(span, impulse.x, previous.x(), to.x);
        output_.means(span, impulse.y, previous.y(), to.y);
        output_.means(span, impulse.z, previous.z(), to.z);
    }

    void look_at_momentum(const Span& span) {
        const double mass = model_.body.mass;
        const Vec3 weight = mass * down_;
        SpanVectors force{}, part{};
        const std::size_t n = span.size();
        force.set(barrier_mean_, span);
        for_others([&](const SpanVectors& impulse, const Vec3& previous) {
            means(span, impulse, previous, part);
            force.add(part, span);
        });
        force.add(weight, span);
        for (std::size_t w = 0; w < now_.tire.size(); ++w) {
            output_.means(span, now_.tire[w], previous_.tire[w], part.z);
            for (std::size_t i = 0; i < n; ++i)
                force.z[i] += part.z[i];
        }
        // No interval ends at the first instant.
        const std::size_t from = span.first == 0 ? 1 : 0;
        const auto greatest = [&](const SpanVectors& vectors) {
            SpanColumn squared;
            BIRM3D_INDEPENDENT
            for (std::size_t i = 0; i < span.filled(); ++i)
                squared[i] =
                    vectors.x[i] * vectors.x[i] + vectors.y[i] * vectors.y[i] + vectors.z[i] * vectors.z[i];
            return std::sqrt(std::max(0.0, greatest_of(squared.data() + from, n - from)));
        };
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < span.filled(); ++i) {
            part.x[i] = mass * moved_.acceleration.x[i] - force.x[i];
            part.y[i] = mass * moved_.acceleration.y[i] - force.y[i];
            part.z[i] = mass * moved_.acceleration.z[i] - force.z[i];
        }
        worst_ = std::max(worst_, greatest(part));
        largest_ = std::max({largest_, greatest(force), greatest(barrier_mean_), weight.norm()});
    }

    void keep_last(const Span& span) {
        const std::size_t last = span.size() - 1;
        previous_.barrier = now_.barrier.at(last);
        if (!forces_ && !momentum_) return;
        previous_.ground = now_.ground.at(last);
        previous_.tire_friction = now_.tire_friction.at(last), previous_.joints = now_.joints.at(last);
        for (std::size_t w = 0; w < now_.tire.size(); ++w)
            previous_.tire[w] = now_.tire[w][last];
    }

    void finish() {
        if (wanted_.normal_force) show_first_mean(unit_.barrier_normal_force);
        if (motion_ && output_.time.size() > 1)
            unit_.acceleration[0] =
                unit_.orientation[0].conjugate() * (unit_.orientation[1] * unit_.acceleration[1]);
        if (!forces_) return;
        for (auto* column : force_columns())
            show_first_mean(*column);
        for (Column& wheel : unit_.tire_reaction)
            show_first_mean(wheel);
    }

    const OutputInstants& output_;
    std::size_t offset_;
    const Unit& model_;
    Vec3 down_;  // acceleration of free fall (m/s^2)
    const Channels& wanted_;
    UnitHistory& unit_;
    bool motion_, forces_, momentum_;
    Pushes pushes_;
    SpanImpulses now_;
    SpanVectors
        barrier_mean_{};  // force of the barrier over the intervals that end at the instants of a span
    SpanMotion moved_{};
    Impulses before_step_;  // up to the start of the step that holds the span
    Impulses passed_;       // of one step
    Impulses previous_;     // up to the last instant of the span before
    double largest_, worst_ = 0.0;
};

}  // namespace

void Recorder::resample_units(const OutputInstants& output, const Scene& scene, const Channels& wanted,
                              History& history) const {
    std::size_t offset = at_units;
    double worst = 0.0, largest = 0.0;
    history.units.resize(scene.vehicle->units.size());
    for (std::size_t u = 0; u < history.units.size(); ++u) {
        const Unit& model = scene.vehicle->units[u];
        UnitRows rows(output, offset, model, scene.settings.gravity, wanted, history.units[u]);
        run_wide([&] { rows.run(history.towards); });
        if (wanted.motion)
            for (Vec3& position : history.units[u].position)
                position += scene.base;
        if (wanted.contact_forces) resample_contact_forces(output, offset, history.units[u]);
        if (wanted.momentum)
            worst = std::max(worst, rows.worst()), largest = std::max(largest, rows.largest());
        offset += unit_width(model);
    }
    history.momentum_residual = largest > 0.0 ? worst / largest : 0.0;
}

}  // namespace birm3d
