#include "scene/indentation_gaps.hpp"

#include <algorithm>

#include "birm3d/base/tolerances.hpp"
#include "kernels/integrate.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

// A block or a group of blocks with a lower bound of its gaps.
struct Bound {
    double gap;
    std::size_t number;  // of the block or group

    bool operator<(const Bound& other) const { return gap < other.gap; }
};

// Of those groups that can come within `far`, the nearest first.
std::vector<Bound> groups_by_gap(const Indentation& indentation, std::size_t panel, const TrussMesh& mesh,
                                 const UnitState& unit, double far) {
    std::vector<Bound> bounds;
    for (std::size_t g = 0; g < unit.trusses.groups.size(); ++g) {
        if ((mesh.panels_of_group[g] >> panel & 1U) == 0) continue;
        const double gap = -most_inside(indentation, unit.trusses.groups[g].box);
        if (gap <= far) bounds.push_back({gap, g});
    }
    std::sort(bounds.begin(), bounds.end());
    return bounds;
}

}  // namespace

bool draws_in_skin(const Obstacle& obstacle) {
    return obstacle.top_edge.has_value() || std::holds_alternative<Post>(obstacle.shape);
}

bool can_indent(const Obstacle& obstacle, const Placement& stands, const Panel& panel, const Twist& motion,
                bool indents) {
    return obstacle.top_edge ? can_indent(*obstacle.top_edge, stands, panel, indents)
                             : can_indent(std::get<Post>(obstacle.shape), stands, panel, motion, indents);
}

Indentation indentation_by(const Obstacle& obstacle, const Placement& stands, const Panel& panel,
                           const TrussMesh& mesh, const Settings& settings) {
    if (obstacle.top_edge) return {*obstacle.top_edge, stands, panel, mesh.indentation_length};
    return {std::get<Post>(obstacle.shape), stands, panel, mesh.indentation_length,
            settings.edge_flank_factor};
}

double gap_of_panel(const Indentation& indentation, std::size_t panel, const TrussMesh& mesh,
                    const UnitState& unit, double far, double enough) {
    double least = infinity;
    std::vector<Bound> blocks;
    for (const Bound& group : groups_by_gap(indentation, panel, mesh, unit, far)) {
        if (group.gap > least) break;
        blocks.clear();
        for (std::size_t b = group.number * TrussMesh::group_size; b < mesh.end_of_group(group.number); ++b) {
            if ((mesh.panels_of[b] >> panel & 1U) == 0) continue;
            const double bound = -most_inside(indentation, unit.trusses.block[b].box);
            if (bound <= std::min(far, least)) blocks.push_back({bound, b});
        }
        std::sort(blocks.begin(), blocks.end());
        for (const Bound& block : blocks) {
            if (block.gap > least) break;
            least = std::min(least, gap_of(indentation, unit.trusses.block[block.number],
                                           mesh.block[block.number], panel));
            if (least <= enough) return least;
        }
    }
    return least;
}

namespace {

// Calls `use` with each indentation that is made or would be made, and with the indices of the obstacle and the panel.
// `about`: indices of the obstacles. `distance`: posts that are no further than this beside, in front of or below a
// panel count too (m).
template <class Use>
void for_each_indentation(const Scene& scene, const UnitState& unit, const Unit& model,
                          const std::vector<std::size_t>& about, double distance, const Use& use) {
    const TrussMesh& mesh = model.trusses;
    const Twist motion = twist_in_body_axes(model.body, unit.body);
    for (const std::size_t i : about) {
        const Obstacle& obstacle = scene.obstacles[i];
        if (!draws_in_skin(obstacle)) continue;
        const Placement in_shape =
            placement({obstacle.rotation, obstacle.position}, unit.body);  // it is fixed
        for (std::size_t p = 0; p < panels; ++p) {
            const Panel& panel = mesh.panel[p];
            if (!panel.any || !can_indent(obstacle, in_shape, panel, motion, false)) continue;
            Indentation indentation = indentation_by(obstacle, in_shape, panel, mesh, scene.settings);
            if (!(indentation.beside() < distance) || indentation.is_beyond(panel)) continue;
            if (distance > 0.0) {
                indentation.low = -infinity;
                indentation.high = infinity;
                indentation.edge_allowance = infinity;
            }
            use(indentation, i, p);
        }
    }
}

}  // namespace

double overlap_of_indentations(const Scene& scene, const State& state, double deepest) {
    double most = 0.0;
    std::vector<std::size_t> about;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const TrussMesh& mesh = scene.vehicle->units[u].trusses;
        if (mesh.indentation_length == 0.0) continue;
        scene.map.find(state.units[u].body.position, state.units[u].trusses.around.radius(), about);
        for_each_indentation(scene, state.units[u], scene.vehicle->units[u], about, 0.0,
                             [&](const Indentation& indentation, std::size_t, std::size_t panel) {
                                 const double gap =
                                     gap_of_panel(indentation, panel, mesh, state.units[u], 0.0, -infinity);
                                 if (-gap < deepest) most = std::max(most, -gap);
                             });
    }
    return most;
}

namespace {

// Nodes that an indentation has just released lie on it to rounding: below this gap it counts as reached (m).
constexpr double come = tolerance::touching_gap;

// Does the post indent the panel already? Then nodes that it has released do not follow it again, however near it is.
bool indents_already(const UnitState& unit, std::size_t obstacle, std::size_t panel) {
    return (panels_by(unit.indented, obstacle).panels >> panel & 1U) != 0;
}

}  // namespace

double step_to_indentation(const Scene& scene, const UnitState& unit, const Unit& model, double fastest,
                           double longest) {
    const TrussMesh& mesh = model.trusses;
    std::vector<std::size_t> about;
    const double distance = longest * fastest;
    scene.map.find(unit.body.position, unit.trusses.around.radius() + distance, about);
    for_each_indentation(
        scene, unit, model, about, distance,
        [&](const Indentation& indentation, std::size_t obstacle, std::size_t panel) {
            if (indents_already(unit, obstacle, panel)) return;
            // A post indents a panel that it moves into from in front.
            const double grows = indentation.fastest_growth(mesh.panel[panel]);
            const double gap = gap_of_panel(indentation, panel, mesh, unit, grows * distance, come);
            if (gap > come)
                longest = std::min(longest, (gap + tolerance::untouched_distance) / (grows * fastest));
        });
    return longest;
}

}  // namespace birm3d
