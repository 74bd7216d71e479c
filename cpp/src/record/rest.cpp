#include "record/rest.hpp"

#include <algorithm>
#include <limits>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

double rest_energy(const Scene& scene) {
    double start = 0.0;
    for (const Unit& unit : scene.vehicle->units)
        start += 0.5 * unit.body.mass * scene.approach.speed * scene.approach.speed;
    return 1e-6 * start;
}

void note_slowness(const Scene& scene, const State& state, Event& event) {
    if (state.energies.kinetic < rest_energy(scene))
        event.slow_since = std::min(event.slow_since, state.time);
    else
        event.slow_since = std::numeric_limits<double>::infinity();
}

bool rests(const Scene& scene, const State& state, const Event& event) {
    return state.energies.kinetic + state.energies.stored < rest_energy(scene) ||
           state.time - event.slow_since >= tolerance::rest_duration;
}

}  // namespace birm3d
