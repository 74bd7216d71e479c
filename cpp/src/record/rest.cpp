#include "record/rest.hpp"

#include <algorithm>
#include <limits>

#include "birm3d/base/tolerances.hpp"
#include "control/end_of_event.hpp"

namespace birm3d {

void note_slowness(const Scene& scene, const State& state, Event& event) {
    if (state.energies.kinetic < rest_energy(scene))
        event.slow_since = std::min(event.slow_since, state.time);
    else
        event.slow_since = std::numeric_limits<double>::infinity();
}

bool rests(const Scene& scene, const State& state, const Event& event) {
    return at_rest(scene, state) || state.time - event.slow_since >= tolerance::rest_duration;
}

}  // namespace birm3d
