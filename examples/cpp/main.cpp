// A crash in C++: a block of 6.8 t with a crushable front meets a wall at 50 mph.
//
// Its crush, peak force and rebound are known exactly, so that the last lines show what the computation is
// worth. SI units throughout; body axes are r (forward), s (left) and t (up) from the mass centre.
#include <algorithm>
#include <birm3d/simulation/simulation.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

int main() {
    using namespace birm3d;

    // The skin: 20 by 12 nodes on a face 2.4 m by 1.6 m, each tied by one truss to a point 2 m behind it.
    // One curve serves them all, scaled to equal shares: 3 MN/m up to 0.4 m, then 6 MN/m without a limit;
    // unloading 60 MN/m.
    constexpr int columns = 20, rows = 12;
    constexpr double k1 = 3e6, knee = 0.4, k2 = 6e6, k_unloading = 60e6;
    TrussInput skin;
    skin.curve = {knee_curve(k1, knee, k2, std::numeric_limits<double>::infinity(), k_unloading)};
    for (int i = 0; i < columns * rows; ++i) {
        const double y = -1.2 + 2.4 * (i % columns) / (columns - 1);
        const double z = -0.8 + 1.6 * (i / columns) / (rows - 1);
        skin.node.emplace_back(3.0, y, z);
        skin.anchor.emplace_back(1.0, y, z);
        skin.curve_of.push_back(0);
        skin.scale.push_back(1.0 / (columns * rows));
    }

    // The vehicle: one rigid unit without wheels, 6,804 kg.
    const RigidBody body(6804.0, Vec3(5000.0, 40000.0, 42000.0).asDiagonal());
    Vehicle block;
    block.units.emplace_back(body, skin, std::vector<Wheel>{}, 0.0);

    // The wall x = 0 without friction, met head-on at 50 mph; neither gravity nor ground.
    const double speed = 22.352;
    Settings settings;
    settings.gravity = 0.0;
    settings.ground = false;
    Simulation simulation(Scene(std::make_shared<const Vehicle>(std::move(block)),
                                std::make_shared<const Barrier>(Barrier::wall(0.0, Vec3::Zero(), 0.0)),
                                Approach{speed, 0.5 * std::numbers::pi, 0.0, 0.0}, settings, {}));
    simulation.run([] {});  // the function is called now and then: a place to look for an interruption

    // The end state holds the trusses; the recorder makes evenly spaced histories of the steps.
    double crush = 0.0;
    for (const TrussBlockState& part : simulation.state().units[0].trusses.block)
        crush = std::max(crush, *std::max_element(part.peak_deflection.begin(), part.peak_deflection.end()));
    const History history = simulation.recorder().resample(simulation.scene());
    const Column& force = history.units[0].barrier_normal_force;
    const double peak = *std::max_element(force.begin(), force.end());
    const double rebound = -simulation.state().units[0].body.velocity.x();

    // Exact: kinetic energy = area under the curve; the rebound has what unloading gives back.
    const double rest = 0.5 * body.mass * speed * speed - 0.5 * k1 * knee * knee;
    const double beyond = (std::sqrt(k1 * knee * k1 * knee + 2.0 * k2 * rest) - k1 * knee) / k2;
    const double exact_peak = k1 * knee + k2 * beyond;
    const double exact_rebound = exact_peak / std::sqrt(k_unloading * body.mass);

    std::printf("%-16s %12s %12s\n", "", "computed", "exact");
    std::printf("%-16s %12.5f %12.5f\n", "crush [m]", crush, knee + beyond);
    std::printf("%-16s %12.2f %12.2f\n", "peak force [kN]", peak / 1e3, exact_peak / 1e3);
    std::printf("%-16s %12.5f %12.5f\n", "rebound [m/s]", rebound, exact_rebound);

    const Energies& end = simulation.state().energies;
    const double start = history.energy(&birm3d::Energies::kinetic).front();
    std::printf(
        "\nenergy [kJ]: %.3f before; after: kinetic %.3f, crushed %.3f, stored %.3f, left over %.1e\n",
        start / 1e3, end.kinetic / 1e3, end.crushed / 1e3, end.stored / 1e3, (end.total() - start) / 1e3);
    std::printf("momentum: m a and the sum of forces differ by %.1e of the greatest force\n",
                history.momentum_residual);
    std::printf("%llu steps for %.1f ms\n",
                static_cast<unsigned long long>(simulation.state().statistics.steps),
                1e3 * simulation.state().time);
}
