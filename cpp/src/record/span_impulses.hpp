// Impulses on a unit at some output instants within one step, computed together.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "record/resample_rows.hpp"

namespace birm3d {

// A vector at each instant of a span, component by component: loops over it fill whole registers (Span::filled).
struct SpanVectors {
    SpanColumn x, y, z;
    Vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
    std::array<double*, 3> columns() { return {x.data(), y.data(), z.data()}; }
    void set(const SpanVectors& from, const Span& span) {
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < span.filled(); ++i)
            x[i] = from.x[i], y[i] = from.y[i], z[i] = from.z[i];
    }
    void add(const Vec3& by, const Span& span) {
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < span.filled(); ++i)
            x[i] += by.x(), y[i] += by.y(), z[i] += by.z();
    }
    void add(const SpanVectors& by, const Span& span) {
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < span.filled(); ++i)
            x[i] += by.x[i], y[i] += by.y[i], z[i] += by.z[i];
    }
};

// What may push a unit beside the barrier and the wheels' normal forces; false where it never does in a record.
struct Pushes {
    bool ground, tire_friction, joints;
};

// Impulses on a unit at the instants of a span: from the start of the step, then from the start of the run (N s).
// Columns of what never pushes are zero from the start, and stay so.
struct SpanImpulses {
    SpanVectors barrier{}, ground{}, tire_friction{}, joints{};
    std::vector<SpanColumn> tire;

    void set(const OutputInstants& output, const Span& span, const StepView& step, const Pushes& pushes) {
        integrate(output, span, step, at_barrier_force, at_barrier_curvature, at_barrier_impulse, barrier);
        if (pushes.ground)
            integrate(output, span, step, at_ground_force, at_ground_curvature, at_ground_impulse, ground);
        const auto spread = [&](std::size_t from, SpanVectors& to) {
            for (std::size_t c = 0; c < 3; ++c)
                output.spread(span, step.b[from + c], to.columns()[c]);
        };
        if (pushes.tire_friction) spread(at_tire_friction, tire_friction);
        if (pushes.joints) spread(at_joint_impulse, joints);
        for (std::size_t w = 0; w < tire.size(); ++w)
            output.spread(span, step.b[at_tire_impulses + w], tire[w].data());
    }
    void add(const Impulses& by, const Span& span, const Pushes& pushes) {
        barrier.add(by.barrier, span);
        if (pushes.ground) ground.add(by.ground, span);
        if (pushes.tire_friction) tire_friction.add(by.tire_friction, span);
        if (pushes.joints) joints.add(by.joints, span);
        for (std::size_t w = 0; w < tire.size(); ++w)
            for (std::size_t i = 0; i < span.filled(); ++i)
                tire[w][i] += by.tire[w];
    }
    static void integrate(const OutputInstants& output, const Span& span, const StepView& step,
                          std::size_t force, std::size_t curvature, std::size_t impulse, SpanVectors& to) {
        for (std::size_t c = 0; c < 3; ++c)
            output.integrate(span, step.a[force + c], step.b[force + c], step.b[curvature + c],
                             step.b[impulse + c], to.columns()[c]);
    }
};

}  // namespace birm3d
