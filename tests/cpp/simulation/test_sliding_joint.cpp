// A load bed that slides along a frame: exact solutions, conservation, and a bed that stays.
#include <cmath>

#include "birm3d/base/error.hpp"
#include "check.hpp"
#include "kernels/integrate.hpp"
#include "kernels/joints.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::infinity;
using laboratory::pi;
using laboratory::speck;

namespace {

constexpr double frame_mass = 3000.0, bed_mass = 4000.0;
constexpr double reduced_mass = frame_mass * bed_mass / (frame_mass + bed_mass);

// Frame and bed, floating, `slide` as the joint's force. The bed's mass centre is higher than the frame's by `lift` (m).
Scene floating(const std::vector<SlideKnot>& slide, double lift, double tolerance, double duration) {
    const Unit frame(RigidBody(frame_mass, Vec3(2000.0, 15000.0, 15000.0).asDiagonal()), speck(), {}, 1.0);
    const Unit bed(RigidBody(bed_mass, Vec3(2500.0, 9000.0, 9500.0).asDiagonal()), speck(), {}, 1.0 + lift,
                   Vec3(-1.5, 0.0, 0.0));
    const Vec3 on_frame(-1.5, 0.0, 0.2), on_bed(0.0, 0.0, 0.2 - lift);
    const Joint joint{JointKind::sliding, 0, 1, on_frame, on_bed, 0.0, slide};
    const auto vehicle = std::make_shared<const Vehicle>(joined({frame, bed}, {joint}));
    return {vehicle, nullptr, Approach{0.0, 0.5 * pi, 0.0, 0.0}, laboratory::weightless(tolerance), duration};
}

// The pair turned to some attitude and spinning, with the bed faster than the frame by `speed` along it.
Simulation sliding(const Scene& scene, double speed, const Vec3& spin) {
    Simulation simulation(scene);
    Simulation::Snapshot start = simulation.snapshot();
    const Quat attitude(Eigen::AngleAxisd(0.7, Vec3(0.3, -0.5, 0.8).normalized()));
    const Vec3 pivot = start.state.units[0].body.position;
    double energy = 0.0;
    for (std::size_t u = 0; u < 2; ++u) {
        const RigidBody& rigid = scene.vehicle->units[u].body;
        BodyState& body = start.state.units[u].body;
        body.position = pivot + attitude * (body.position - pivot);
        body.orientation = attitude * body.orientation;
        body.velocity = spin.cross(body.position - pivot);
        if (u == 1) body.velocity += speed * (attitude * Vec3::UnitX());
        const Mat3 R = body.orientation.toRotationMatrix();
        body.angular_momentum = R * rigid.inertia * R.transpose() * spin;
        energy += kinetic_energy(rigid, body);
    }
    start.state.energies.kinetic = energy;
    start.recorder = Recorder(scene, start.state);
    simulation.restore(start);
    return simulation;
}

double slip(const Simulation& simulation) {
    const State& state = simulation.state();
    return slip_of(simulation.scene().joints[0], state.units[0].body, state.units[1].body);
}

Vec3 momentum(const State& state) {
    return frame_mass * state.units[0].body.velocity + bed_mass * state.units[1].body.velocity;
}

Vec3 angular_momentum(const State& state) {
    const BodyState &a = state.units[0].body, &b = state.units[1].body;
    return frame_mass * a.position.cross(a.velocity) + a.angular_momentum +
           bed_mass * b.position.cross(b.velocity) + b.angular_momentum;
}

}  // namespace

TEST("a sliding bed stops where the work of its force is the energy of its relative motion") {
    // 1/2 mu v^2 = F s + 1/2 k s^2, with the reduced mass mu; the time for a constant force is mu v / F.
    const double speed = 5.0, force = 6e4;
    for (const double rise : {0.0, 5e4}) {
        const Scene scene = floating({{0.0, force}, {10.0, force + 10.0 * rise}}, 0.0, 1e-3, 1.0);
        Simulation simulation = sliding(scene, speed, Vec3::Zero());
        laboratory::run(simulation);
        const double energy = 0.5 * reduced_mass * speed * speed;
        const double exact =
            rise == 0.0 ? energy / force : (std::sqrt(force * force + 2.0 * rise * energy) - force) / rise;
        CHECK_CLOSE(slip(simulation) / exact, 1.0, 5e-4,
                    "it stops within a step of up to 2 ms: F dt^2 / (2 mu)");
        CHECK_CLOSE(simulation.state().energies.sliding / energy, 1.0, 1e-9, "all of it is lost there");
        CHECK_CLOSE(simulation.state().energies.joints / energy, 0.0, 1e-9, "nothing turns");
    }
}

TEST("a bed that slides on a tumbling frame keeps momenta and the balance of energy") {
    const Vec3 spin(0.4, -1.2, 2.0);
    std::vector<double> residuals;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        const Scene scene = floating({{0.0, 4e4}, {0.5, 2e4}}, 0.6, tolerance, 0.5);
        Simulation simulation = sliding(scene, 3.0, spin);
        const Vec3 linear = momentum(simulation.state()), angular = angular_momentum(simulation.state());
        const double total = simulation.state().energies.total();
        double lost = 0.0;
        while (simulation.step()) {
            const State& now = simulation.state();
            CHECK_CLOSE((momentum(now) - linear).norm() / linear.norm(), 0.0, 1e-12, "rounding");
            CHECK_CLOSE((angular_momentum(now) - angular).norm() / angular.norm(), 0.0, 1e-12, "rounding");
            CHECK_CLOSE(now.energies.total() / total, 1.0, 1e-12, "every impulse is booked");
            CHECK(now.energies.sliding >= lost - 1e-9 * total);
            lost = now.energies.sliding;
        }
        CHECK(lost > 0.01 * total);
        residuals.push_back(std::abs(simulation.state().energies.joints) / total);
        CHECK_CLOSE(residuals.back(), 0.0, tolerance, "the tolerance asked for");
    }
    CHECK(residuals[2] < 0.5 * residuals[0]);
}

TEST("a bed stays where holding it takes less than its fixings bear, and is as if welded") {
    // The frame is stopped by a spring: the bed needs m_bed / (m_frame + m_bed) of its force, at most v sqrt(k m).
    const double speed = 2.0, stiffness = 4e5;
    const double peak = speed * std::sqrt(stiffness * (frame_mass + bed_mass));
    const double on_bed = peak * bed_mass / (frame_mass + bed_mass);
    const auto crash = [&](const Joint& joint) {
        TrussInput front = speck();
        front.node = {{2.0, 0.0, 0.0}};
        front.curve = {laboratory::elastic_curve(stiffness)};
        const Unit frame(RigidBody(frame_mass, Vec3(2000.0, 15000.0, 15000.0).asDiagonal()), front, {}, 1.0);
        const Unit bed(RigidBody(bed_mass, Vec3(2500.0, 9000.0, 9500.0).asDiagonal()), speck(), {}, 1.0,
                       Vec3(-1.5, 0.0, 0.0));
        const auto vehicle = std::make_shared<const Vehicle>(joined({frame, bed}, {joint}));
        Simulation simulation(Scene(vehicle, laboratory::wall(0.0), Approach{speed, 0.5 * pi, 0.0, 0.01},
                                    laboratory::weightless(1e-4), 0.5));
        laboratory::run(simulation);
        return simulation;
    };
    const Vec3 ahead(-1.5, 0.0, 0.0), behind = Vec3::Zero();
    const auto with_force = [&](double force) {
        return crash({JointKind::sliding, 0, 1, ahead, behind, 0.0, {{0.0, force}}});
    };
    const Simulation held = with_force(1.01 * on_bed), loose = with_force(0.99 * on_bed);
    const Simulation welded = crash({JointKind::welded, 0, 1, ahead, behind, 0.0});
    CHECK_CLOSE(slip(held), 0.0, 1e-9, "rounding of positions");
    CHECK(slip(loose) > 1e-5);
    CHECK_CLOSE((held.state().units[1].body.position - welded.state().units[1].body.position).norm(), 0.0,
                1e-6, "steps of other lengths");
    CHECK_CLOSE(held.state().energies.sliding, 0.0, 1e-9 * held.state().energies.total(), "nothing slid");
}

TEST("a sliding joint needs a force that it holds") {
    const auto with = [](const std::vector<SlideKnot>& slide) { return floating(slide, 0.6, 1e-3, 0.1); };
    CHECK_THROWS(with({}), InvalidArgument);
    CHECK_THROWS(with({{0.1, 1e4}}), InvalidArgument);
    CHECK_THROWS(with({{0.0, 1e4}, {0.0, 2e4}}), InvalidArgument);
    CHECK_THROWS(with({{0.0, -1.0}}), InvalidArgument);
    CHECK_THROWS(with({{0.0, infinity}}), InvalidArgument);
}
