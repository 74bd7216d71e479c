#include "birm3d/sim/panel_dents.hpp"

#include <algorithm>
#include <limits>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/sim/obstacles.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

double gap_of_panel(const Dent& dent, std::size_t panel, const TrussMesh& mesh, const TrussState& trusses,
                    double far, double enough) {
    // No node of the block is nearer than this. The block that may be nearest comes first: few others are left to ask.
    const auto no_less = [&](std::size_t b) {
        return (mesh.panels_of[b] >> panel & 1U) != 0 ? -most_inside(dent, box_of(trusses.block[b]))
                                                      : infinity;
    };
    std::size_t first = 0;
    double nearest = infinity;
    for (std::size_t b = 0; b < mesh.blocks; ++b) {
        const double bound = no_less(b);
        if (bound < nearest) nearest = bound, first = b;
    }
    double least = infinity;
    alignas(64) Lanes gap;
    const auto ask = [&](std::size_t b) {
        gap_of(dent, trusses.block[b], gap);
        for (std::size_t i = 0; i < lanes; ++i)
            if (mesh.block[b].panel[i] == static_cast<double>(panel)) least = std::min(least, gap[i]);
    };
    if (nearest > far) return least;
    ask(first);
    for (std::size_t b = 0; b < mesh.blocks && least > enough; ++b)
        if (b != first && no_less(b) <= std::min(far, least)) ask(b);
    return least;
}

namespace {

// Calls `use` with each dent that a post makes or would make, and its panel's number. `about`: of the obstacles. `whole`:
// as if the panel had no ends.
template <class Use>
void for_each_dent(const Scene& scene, const UnitState& unit, const TrussMesh& mesh,
                   const std::vector<std::size_t>& about, bool whole, const Use& use) {
    for (const std::size_t i : about) {
        const Obstacle& obstacle = scene.obstacles[i];
        const Post* post = std::get_if<Post>(&obstacle.shape);
        if (post == nullptr) continue;
        const Placement seen =
            placement({obstacle.rotation, obstacle.position}, unit.body);  // posts are fixed
        for (std::size_t p = 0; p < panels; ++p) {
            const Panel& panel = mesh.panel[p];
            if (!panel.any || !stands_across(seen, panel, false)) continue;
            Dent dent(*post, seen, panel, mesh.dent_reach);
            if (whole) {
                dent.low = -infinity;
                dent.high = infinity;
            } else if (!dent.overlaps(panel)) {
                continue;
            }
            use(dent, p);
        }
    }
}

}  // namespace

double overlap_of_dents(const Scene& scene, const State& state, double deepest) {
    double most = 0.0;
    std::vector<std::size_t> about;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const TrussMesh& mesh = scene.vehicle->units[u].trusses;
        if (mesh.dent_reach == 0.0) continue;
        scene.map.find(state.units[u].body.position, everything(mesh, state.units[u]).half.norm(), about);
        for_each_dent(scene, state.units[u], mesh, about, false, [&](const Dent& dent, std::size_t panel) {
            const double gap = gap_of_panel(dent, panel, mesh, state.units[u].trusses, 0.0, -infinity);
            if (-gap < deepest) most = std::max(most, -gap);
        });
    }
    return most;
}

double undented_step(const Scene& scene, const UnitState& unit, const TrussMesh& mesh, double fastest,
                     double longest) {
    std::vector<std::size_t> about;
    // A post dents what it comes into.
    scene.map.find(unit.body.position, everything(mesh, unit).half.norm() + longest * fastest, about);
    for_each_dent(scene, unit, mesh, about, true, [&](const Dent& dent, std::size_t panel) {
        const double grows = dent.fastest_growth(mesh.panel[panel]) * fastest;
        const double far = grows * longest - tolerance::untouched_way;
        const double gap = far > 0.0 ? gap_of_panel(dent, panel, mesh, unit.trusses, far, 0.0) : infinity;
        if (gap > 0.0) longest = std::min(longest, (gap + tolerance::untouched_way) / grows);
    });
    return longest;
}

}  // namespace birm3d
