// The layout of the rows of a record, and the integrals of loads over a step between two rows.
#pragma once

#include "birm3d/record/recorder.hpp"

namespace birm3d {

// Where the numbers of a row stand. Energies and bodies at the end of the step, impulses within it.
enum RowOffset : std::size_t { at_time = 0, at_energies = 1, at_units = at_energies + energy_terms.size() };
enum UnitOffset : std::size_t {
    at_position = 0,
    at_orientation = 3,  // x, y, z, w
    at_velocity = 7,
    at_angular_velocity = 10,  // body axes
    at_barrier_force = 13,     // contact and friction, world axes
    at_normal_force = 16,      // sum of the magnitudes over the nodes
    at_tire_friction = 17,     // impulse
    at_barrier_impulse = 20,
    at_normal_impulse = 23,
    at_barrier_curvature = 24,  // impulse of the parabola that the higher order adds to the linear force
    at_normal_curvature = 27,
    at_ground_force = 28,  // of the ground on the skin: the same three as of the barrier
    at_ground_impulse = 31,
    at_ground_curvature = 34,
    at_joint_impulse = 37,
    at_tire_impulses = 40
};
// And in the numbers of an obstacle: force and torque on it, about its own point, world axes.
enum ObstacleOffset : std::size_t {
    at_load = 0,
    at_load_impulse = 6,
    at_load_curvature = 12,
    obstacle_width = 18
};
// Behind the units: for each joint force and moment impulse.
constexpr std::size_t joint_width = 6;
// Behind the joints: for each moving element its motion.
enum MovingElementOffset : std::size_t {
    at_element_position = 0,
    at_element_orientation = 3,
    at_element_velocity = 7,
    at_element_spin = 10,
    element_width = 11
};

inline std::size_t unit_width(const Unit& unit) {
    return at_tire_impulses + unit.wheels.size();
}

inline Vec3 vec(const double* p) {
    return {p[0], p[1], p[2]};
}

// One step of one unit: its two rows, and the running integrals up to its start.
struct StepView {
    const double* a;  // unit part of the row at the start
    const double* b;  // and at the end
    double dt;

    // Fraction of the step that has passed at `t` from its start. The step of an impact has no length and fraction 1.
    double fraction(double t) const { return dt > 0.0 ? t / dt : 1.0; }
    // Integral from the start of the step to `t` of a force with end values a[i], b[i] (N s). Includes a parabola
    // that is zero at both ends, given by its impulse b[curvature] over the step.
    double force_integral(std::size_t i, std::size_t curvature, double t) const {
        const double s = fraction(t);
        return t * (a[i] + 0.5 * s * (b[i] - a[i])) + s * s * (3.0 - 2.0 * s) * b[curvature];
    }
    Vec3 force_integral3(std::size_t i, std::size_t curvature, double t) const {
        return {force_integral(i, curvature, t), force_integral(i + 1, curvature + 1, t),
                force_integral(i + 2, curvature + 2, t)};
    }
    double impulse(std::size_t i, double t) const { return fraction(t) * b[i]; }
    // Of the barrier on the unit, world axes.
    Vec3 barrier_impulse(double t) const {
        return force_integral3(at_barrier_force, at_barrier_curvature, t) +
               fraction(t) * vec(b + at_barrier_impulse);
    }
    // Of the magnitudes of the normal forces of all nodes.
    double contact_impulse(double t) const {
        return force_integral(at_normal_force, at_normal_curvature, t) + impulse(at_normal_impulse, t);
    }
};

// Impulses since the start of the run (N s).
struct Impulses {
    Vec3 barrier = Vec3::Zero(), ground = Vec3::Zero();
    Vec3 tire_friction = Vec3::Zero();
    Vec3 joints = Vec3::Zero();
    Column tire;

    // Those within a step up to `t` from its start.
    void set(const StepView& step, double t, std::size_t wheels) {
        barrier = step.barrier_impulse(t);
        ground = step.force_integral3(at_ground_force, at_ground_curvature, t) +
                 step.fraction(t) * vec(step.b + at_ground_impulse);
        tire_friction = step.fraction(t) * vec(step.b + at_tire_friction);
        joints = step.fraction(t) * vec(step.b + at_joint_impulse);
        tire.resize(wheels);
        for (std::size_t w = 0; w < wheels; ++w)
            tire[w] = step.impulse(at_tire_impulses + w, t);
    }
    Impulses& operator+=(const Impulses& other) {
        barrier += other.barrier;
        ground += other.ground;
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

}  // namespace birm3d
