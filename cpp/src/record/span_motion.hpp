// The motion of a unit at some output instants within one step, worked out together.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "record/span_impulses.hpp"

namespace birm3d {

// Components are written as Eigen's expressions would be: the order of the operations is the same.
struct SpanMotion {
    SpanVectors position, velocity;         // world (m, m/s)
    SpanVectors acceleration;               // mean since the instant before, world (m/s^2)
    SpanVectors body_acceleration;          // the same in body axes
    std::array<SpanColumn, 4> orientation;  // x, y, z, w

    // `impulse`: from the start of the step (N s); `down`: acceleration of free fall (m/s^2).
    void set_velocity(const OutputInstants& output, const Span& span, const StepView& step,
                      const SpanVectors& impulse, double inverse_mass, const Vec3& down) {
        const double *fraction = output.fraction.data() + span.first,
                     *within = output.within.data() + span.first;
        const std::array from = {impulse.x.data(), impulse.y.data(), impulse.z.data()};
        for (std::size_t c = 0; c < 3; ++c) {
            const double a = step.a[at_velocity + c], b = step.b[at_velocity + c];
            const double g = down[static_cast<Eigen::Index>(c)];
            double* to = velocity.columns()[c];
            BIRM3D_INDEPENDENT
            for (std::size_t i = 0; i < span.filled(); ++i) {
                const double v = a + inverse_mass * from[c][i] + within[i] * g;
                to[i] = fraction[i] < 1.0 ? v : b;
            }
        }
    }

    // Cubic Hermite for the path; the chord of the unit sphere for the small turn.
    void set_place(const OutputInstants& output, const Span& span, const StepView& step) {
        const double *fraction = output.fraction.data() + span.first,
                     *smooth = output.smooth.data() + span.first;
        for (std::size_t c = 0; c < 3; ++c) {
            const double a = step.a[at_position + c], b = step.b[at_position + c];
            const double va = step.a[at_velocity + c], vb = step.b[at_velocity + c];
            double* to = position.columns()[c];
            BIRM3D_INDEPENDENT
            for (std::size_t i = 0; i < span.filled(); ++i) {
                const double s = fraction[i];
                to[i] = a + (b - a) * smooth[i] + step.dt * s * (1.0 - s) * ((1.0 - s) * va - s * vb);
            }
        }
        const double *qa = step.a + at_orientation, *qb = step.b + at_orientation;
        const double side =
            Eigen::Map<const Eigen::Vector4d>(qa).dot(Eigen::Map<const Eigen::Vector4d>(qb)) < 0.0 ? -1.0
                                                                                                   : 1.0;
        for (std::size_t c = 0; c < 4; ++c) {
            BIRM3D_INDEPENDENT
            for (std::size_t i = 0; i < span.filled(); ++i)
                orientation[c][i] = (1.0 - fraction[i]) * qa[c] + fraction[i] * side * qb[c];
        }
        auto& [x, y, z, w] = orientation;
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < span.filled(); ++i) {
            const double norm = std::sqrt((x[i] * x[i] + z[i] * z[i]) + (y[i] * y[i] + w[i] * w[i]));
            x[i] /= norm, y[i] /= norm, z[i] /= norm, w[i] /= norm;
        }
    }

    // `before`: velocity at the instant before the span.
    void set_acceleration(const OutputInstants& output, const Span& span, const Vec3& before) {
        output.means(span, velocity.x, before.x(), acceleration.x);
        output.means(span, velocity.y, before.y(), acceleration.y);
        output.means(span, velocity.z, before.z(), acceleration.z);
        // By the conjugate of the orientation q: v + w u + q x u with u = 2 q x v.
        const auto& [qx, qy, qz, qw] = orientation;
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < span.filled(); ++i) {
            const double x = -qx[i], y = -qy[i], z = -qz[i], w = qw[i];
            const double ax = acceleration.x[i], ay = acceleration.y[i], az = acceleration.z[i];
            double ux = y * az - z * ay, uy = z * ax - x * az, uz = x * ay - y * ax;
            ux += ux, uy += uy, uz += uz;
            body_acceleration.x[i] = ax + w * ux + (y * uz - z * uy);
            body_acceleration.y[i] = ay + w * uy + (z * ux - x * uz);
            body_acceleration.z[i] = az + w * uz + (x * uy - y * ux);
        }
    }

    Quat orientation_at(std::size_t i) const {
        return Quat(orientation[3][i], orientation[0][i], orientation[1][i], orientation[2][i]);
    }
};

}  // namespace birm3d
