// The blocks of one unit, one after the other: each finds what it can meet, is crushed on it and adds its forces.
#include "contact/contact_pass.hpp"

#include "base/block_loop.hpp"
#include "birm3d/base/tolerances.hpp"
#include "contact/block_crush.hpp"
#include "contact/candidates.hpp"
#include "contact/contact_forces.hpp"
#include "contact/contact_loads.hpp"
#include "contact/indentation.hpp"
#include "contact/nearest_surface.hpp"
#include "contact/released_nodes.hpp"
#include "contact/tire_contact.hpp"

namespace birm3d {

namespace {

BIRM3D_BLOCK_LOOP double least(const BlockColumn& values) {
    alignas(64) BlockColumn negative;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        negative[i] = -values[i];
    return -block_max(negative);
}

// A block that pushes nowhere and is inside nothing stays as it is.
bool stays_free(const ContactBlock& block) {
    return !block.start->touching && !block.start->slack && !block.is_altered() &&
           least(block.faces.gap) >= 0.0;
}

void count_met_nodes(const ContactPass& pass, std::size_t b, StepStatistics& statistics) {
    if (pass.before.trusses.block[b].met) return;
    (b < pass.mesh.shell_blocks ? statistics.skin_nodes : statistics.tire_nodes) += pass.mesh.nodes_in(b);
}

// Takes one block through the step.
void apply_contact(const ContactPass& pass, std::size_t b, ContactState& state, Trial& trial) {
    ContactBlock& block = state.block;
    block.begin(b, pass.before.trusses.block[b], trial.state.units[pass.unit_index].trusses.block[b]);
    snap_back(pass, block);
    find_block_candidates(pass, trial.skin, block);
    if (block.reachable.empty() && !block.is_altered()) return;
    trial.state.statistics.node_evaluations += block_size;
    for (const std::size_t k : block.reachable)
        state.sums.obstacles[k].reached = true;
    PlaneSums* const plane = only_plane(pass, block, state.sums);
    if (plane == nullptr && !block.reachable.empty()) {
        find_nearest_surface(pass, block);
        if (stays_free(block)) return;
    }
    trial.active[pass.unit_index].add(b);
    trial.stale[pass.unit_index].add(b);
    count_met_nodes(pass, b, trial.state.statistics);
    if (block.reachable.empty())
        *block.end = block.altered;
    else if (plane != nullptr)
        crush_on_plane(pass, *plane, state);
    else
        crush_on_surfaces(pass, state);
    block.end->met = true;
    block.end->hangs = block.hangs;
    block.end->lagging = block.lagging;
    block.end->box = box_around(block.end->x, block.end->y, block.end->z);
}

// Returns whether the sums are complete. They are not where a released node met a distant obstacle.
bool apply_contacts(const ContactPass& pass, Trial& trial) {
    trial.active[pass.unit_index].clear();
    const TrussState& trusses = pass.before.trusses;
    if (pass.near.empty() && pass.before.contact_loads.empty() && !trusses.has_slack()) return true;
    ContactState state(trial.skin);
    for (std::size_t g = 0; g < trusses.groups.size(); ++g)
        if (find_group_candidates(pass, g, trial.skin))
            for (std::size_t b = g * TrussMesh::group_size; b < pass.mesh.end_of_group(g); ++b)
                apply_contact(pass, b, state, trial);
    add_tire_friction(pass, state.sums);
    return !state.distant.were_met;
}

}  // namespace

void find_contact_forces(const Scene& scene, std::size_t u, const State& from, Trial& trial) {
    const ContactPass near = prepare_pass(scene, u, from, Reach::near, trial);
    if (apply_contacts(near, trial)) return store_loads(near, trial);
    const ContactPass distant = prepare_pass(scene, u, from, Reach::distant, trial);
    apply_contacts(distant, trial);
    store_loads(distant, trial);
}

}  // namespace birm3d
