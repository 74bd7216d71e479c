#include <algorithm>

#include "birm3d/record/event.hpp"

namespace birm3d {

Deflections greatest_deflections(const Vehicle& vehicle, const State& state) {
    constexpr double least = -infinity;
    Deflections found{least, least, least};
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const TrussMesh& mesh = vehicle.units[u].trusses;
        for (std::size_t b = 0; b < mesh.skin_blocks; ++b) {
            const TrussBlockState& block = state.units[u].trusses.block[b];
            for (std::size_t i = 0; i < mesh.nodes_in(b); ++i) {
                const double springback = mesh.springback.empty() ? 0.0 : mesh.springback[b][i];
                found.now = std::max(found.now, block.deflection[i]);
                found.left = std::max(found.left, block.deflection[i] - springback);
                found.peak = std::max(found.peak, block.peak_deflection[i]);
            }
        }
    }
    return found;
}

}  // namespace birm3d
