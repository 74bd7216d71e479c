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
    double least = infinity;
    alignas(64) DentLanes found;
    for (std::size_t b = 0; b < mesh.blocks && least > enough; ++b) {
        const TrussBlockState& block = trusses.block[b];
        if ((mesh.panels_of[b] >> panel & 1U) == 0 ||
            -most_inside(dent, box_of(block)) > std::min(far, least))
            continue;
        dent_of(dent, block, found);
        for (std::size_t i = 0; i < lanes; ++i)
            if (mesh.block[b].panel[i] == static_cast<double>(panel)) least = std::min(least, found.gap[i]);
    }
    return least;
}

namespace {

// Calls `use` with each dent that a post makes or would make, and how far the nodes of the panel are from it, at least
// (m); infinite where that is more than `far`. `about`: of the obstacles. `whole`: as if the panel had no ends.
template <class Use>
void for_each_dent(const Scene& scene, const UnitState& unit, const TrussMesh& mesh,
                   const std::vector<std::size_t>& about, double far, bool whole, const Use& use) {
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
            use(dent.fastest_growth(panel), gap_of_panel(dent, p, mesh, unit.trusses, far, -infinity));
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
        for_each_dent(scene, state.units[u], mesh, about, 0.0, false, [&](double, double gap) {
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
    for_each_dent(scene, unit, mesh, about, (2.0 + mesh.reach / mesh.dent_reach) * longest * fastest, true,
                  [&](double growth, double gap) {
                      if (gap > 0.0)
                          longest = std::min(longest, (gap + tolerance::untouched_way) / (growth * fastest));
                  });
    return longest;
}

}  // namespace birm3d
