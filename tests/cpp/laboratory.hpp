// Bodies and scenes with known answers, shared by the tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "birm3d/simulation/simulation.hpp"

namespace laboratory {

using namespace birm3d;

inline constexpr double pi = std::numbers::pi;

// The law of W2, all trusses together: 3 MN/m to 0.4 m, 6 MN/m beyond, unloading 60 MN/m.
inline TrussCurve w2_curve() {
    return knee_curve(3e6, 0.4, 6e6, infinity, 60e6);
}

inline TrussCurve elastic_curve(double stiffness) {
    return knee_curve(stiffness, infinity, 0.0, infinity, stiffness);
}

inline RigidBody body(double mass = 6804.0) {
    return {mass, Vec3(5000.0, 40000.0, 42000.0).asDiagonal()};
}

// `columns` by `rows` nodes on a flat front face 2.4 m by 1.6 m, 3 m ahead of the mass centre; their trusses
// run 2 m straight back and share the curve's stiffness equally.
inline TrussInput front_face(const TrussCurve& curve, int columns, int rows) {
    TrussInput input;
    const int n = columns * rows;
    for (int i = 0; i < n; ++i) {
        const double y = columns > 1 ? -1.2 + 2.4 * (i % columns) / (columns - 1) : 0.0;
        const double z = rows > 1 ? -0.8 + 1.6 * (i / columns) / (rows - 1) : 0.0;
        input.node.emplace_back(3.0, y, z);
        input.anchor.emplace_back(1.0, y, z);
    }
    input.curve = {curve};
    input.curve_of.assign(input.node.size(), 0);
    input.scale.assign(input.node.size(), 1.0 / n);
    return input;
}

// A small truss that nothing touches: every unit needs a skin.
inline TrussInput speck() {
    TrussInput input;
    input.node = {{0.1, 0.0, 0.0}};
    input.anchor = {{0.0, 0.0, 0.0}};
    input.curve = {elastic_curve(1e6)};
    input.curve_of = {0};
    input.scale = {1.0};
    return input;
}

inline std::shared_ptr<const Vehicle> block(const TrussCurve& curve, int columns = 10, int rows = 10,
                                            std::vector<Wheel> wheels = {}, double mass_center_height = 0.0) {
    Vehicle vehicle;
    vehicle.units.emplace_back(body(), front_face(curve, columns, rows), std::move(wheels),
                               mass_center_height);
    return std::make_shared<const Vehicle>(std::move(vehicle));
}

// Four wheels on whose lowest points the mass centre stands 1 m above the ground.
inline std::vector<Wheel> four_wheels() {
    return {{{1.5, 0.8, -0.6}, 0.4},
            {{1.5, -0.8, -0.6}, 0.4},
            {{-1.5, 0.8, -0.6}, 0.4},
            {{-1.5, -0.8, -0.6}, 0.4}};
}

// Neither gravity nor ground: W1 to W3.
inline Settings weightless(double tolerance = 1e-3) {
    Settings settings;
    settings.tolerance = tolerance;
    settings.gravity = 0.0;
    settings.ground = false;
    return settings;
}

inline std::shared_ptr<const Barrier> wall(double friction = 0.0, double heading = 0.0,
                                           const Vec3& origin = Vec3::Zero()) {
    return std::make_shared<const Barrier>(Barrier::wall(friction, origin, heading));
}

// Signed distance of a place in the world from the nearest element of the scene's barrier (m).
inline double gap_to_barrier(const Scene& scene, const Vec3& place) {
    double least = infinity;
    for (std::size_t i = 0; i < scene.barrier->elements.size(); ++i) {
        const Obstacle& element = scene.obstacles[i];
        const Vec3 own = element.rotation.transpose() * (place - element.position);
        least = std::min(least, nearest(element.shape, own).gap);
    }
    return least;
}

// 50 mph straight at the wall unless stated.
inline Scene scene(std::shared_ptr<const Vehicle> vehicle, std::shared_ptr<const Barrier> barrier,
                   const Settings& settings, double angle = 0.5 * pi, std::optional<double> duration = {}) {
    return {std::move(vehicle), std::move(barrier), Approach{22.352, angle, 0.0, 0.0}, settings, duration};
}

inline void run(Simulation& simulation) {
    simulation.run([] {});
}

// Greatest peak deflection of any truss of the first unit (m).
inline double deepest(const Simulation& simulation) {
    double most = 0.0;
    for (const TrussBlockState& block : simulation.state().units[0].trusses.block)
        for (const double d : block.peak_deflection)
            most = std::max(most, d);
    return most;
}

// What may be printed when Eigen vectors are compared with CHECK_CLOSE.
inline double distance(const Vec3& a, const Vec3& b) {
    return (a - b).norm();
}

}  // namespace laboratory
