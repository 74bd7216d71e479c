#include "record/rest.hpp"

#include <algorithm>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Speed over approach speed below which a vehicle is at rest.
constexpr double rest_share = 1e-3;

// A vehicle creeps below this speed (m/s), and below this share of its approach speed. With smaller limits, a vehicle that skin
// and tyres press on the barrier takes seconds to come to rest. With greater ones, a vehicle that still travels counts as at rest.
constexpr double creeping_speed = 0.02;
constexpr double creeping_share = 0.02;

// Kinetic energy of the whole vehicle at a speed (J).
double kinetic_energy_at(const Scene& scene, double speed) {
    double energy = 0.0;
    for (const Unit& unit : scene.vehicle->units)
        energy += 0.5 * unit.body.mass * speed * speed;
    return energy;
}

// Kinetic energy below which a vehicle creeps: only pressed skin and loaded tyres keep it moving (J).
double creeping_energy(const Scene& scene) {
    const double speed = scene.approach.speed;
    const double creeping = std::min(creeping_speed, creeping_share * speed);
    return kinetic_energy_at(scene, std::max(rest_share * speed, creeping));
}

}  // namespace

double rest_energy(const Scene& scene) {
    return kinetic_energy_at(scene, rest_share * scene.approach.speed);
}

void note_creeping(const Scene& scene, const State& state, Event& event) {
    if (state.energies.kinetic < creeping_energy(scene))
        event.creeping_since = std::min(event.creeping_since, state.time);
    else
        event.creeping_since = infinity;
}

bool rests(const Scene& scene, const State& state, const Event& event) {
    return state.energies.kinetic + state.energies.stored < rest_energy(scene) ||
           state.time - event.creeping_since >= tolerance::rest_duration;
}

}  // namespace birm3d
