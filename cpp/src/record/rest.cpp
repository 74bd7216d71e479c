#include "record/rest.hpp"

#include <algorithm>
#include <limits>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Share of the approach speed below which all is at rest.
constexpr double rest_share = 1e-3;

// A vehicle is slow below this speed (m/s), but not above this share of its approach speed. Small: a vehicle that skin and tyres
// press on the barrier creeps for seconds, ever more slowly. Large: one that still gets somewhere counts as at rest.
constexpr double creeping_speed = 0.02;
constexpr double creeping_share = 0.02;

// Kinetic energy of the whole vehicle at a speed (J).
double kinetic_energy_at(const Scene& scene, double speed) {
    double energy = 0.0;
    for (const Unit& unit : scene.vehicle->units)
        energy += 0.5 * unit.body.mass * speed * speed;
    return energy;
}

// Kinetic energy below which a vehicle creeps: it gets nowhere, though pressed skin and loaded tyres keep it moving (J).
double creeping_energy(const Scene& scene) {
    const double speed = scene.approach.speed;
    const double creeping = std::min(creeping_speed, creeping_share * speed);
    return kinetic_energy_at(scene, std::max(rest_share * speed, creeping));
}

}  // namespace

double rest_energy(const Scene& scene) {
    return kinetic_energy_at(scene, rest_share * scene.approach.speed);
}

void note_slowness(const Scene& scene, const State& state, Event& event) {
    if (state.energies.kinetic < creeping_energy(scene))
        event.slow_since = std::min(event.slow_since, state.time);
    else
        event.slow_since = std::numeric_limits<double>::infinity();
}

bool rests(const Scene& scene, const State& state, const Event& event) {
    return state.energies.kinetic + state.energies.stored < rest_energy(scene) ||
           state.time - event.slow_since >= tolerance::rest_duration;
}

}  // namespace birm3d
