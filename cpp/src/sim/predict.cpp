#include "sim/predict.hpp"

#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/friction.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/sim/bodies.hpp"

namespace birm3d {

namespace {

// World axes, about the mass centre. A wheel that the ground carries is held: whatever friction adds, the ground answers.
Mat6 inertia_on_wheels(const Unit& unit, const Mat3& R, const std::vector<double>& tire_impulses) {
    Mat6 inertia = Mat6::Zero();
    inertia.topLeftCorner<3, 3>().diagonal().array() = unit.body.mass;
    inertia.bottomRightCorner<3, 3>() = R * unit.body.inertia * R.transpose();
    for (std::size_t w = 0; w < unit.wheels.size(); ++w) {
        if (!(tire_impulses[w] > 0.0)) continue;
        Vec6 row;
        row << Vec3::UnitZ(), (R * unit.wheels[w].center).cross(Vec3::UnitZ());
        inertia += tolerance::held_by_ground * unit.body.mass * row * row.transpose();
    }
    return inertia;
}

}  // namespace

Twist predicted_motion(const Scene& scene, std::size_t u, const State& from, const Trial& trial) {
    const Unit& unit = scene.vehicle->units[u];
    const BodyState& start = trial.at_start.happened ? trial.at_start.bodies[u] : from.units[u].body;
    BodyState body = trial.state.units[u].body;
    body.velocity += body.velocity - start.velocity;
    body.angular_momentum += body.angular_momentum - start.angular_momentum;
    Twist motion{body.velocity, angular_velocity(unit.body, body)};
    const Mat3 R = body.orientation.toRotationMatrix();
    const SkinForces& before = from.units[u].skin;
    if (before.resistance.trace() > 0.0)
        motion = settled(motion, before.rubbed, before.resistance, trial.dt,
                         inertia_on_wheels(unit, R, trial.impulses[u].tire));
    return {R.transpose() * motion.velocity, R.transpose() * motion.angular_velocity};
}

void predict_segments(const Scene& scene, const State& from, double dt, State& now) {
    for (const UnitState& unit : from.units)
        for (const Touch& touch : unit.touches) {
            const int body = body_of_obstacle(scene, touch.obstacle);
            if (body < 0) continue;
            Load coming = scaled(touch.course.now, 0.5 * dt);
            coming += scaled(touch.course.rate, dt * dt / 3.0);
            kick_body(scene, static_cast<std::size_t>(body), reaction_of(coming), now);
        }
}

}  // namespace birm3d
