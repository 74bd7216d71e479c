#include "contact/candidates.hpp"

#include <algorithm>

#include "birm3d/base/tolerances.hpp"
#include "contact/indentation.hpp"
#include "contact/indented_panels.hpp"
#include "contact/predicted_motion.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

// How far a node in contact can have moved off its surface within the step (m).
double margin_of(const Scene& scene, std::size_t u, const State& from, const Trial& trial) {
    const Unit& unit = scene.vehicle->units[u];
    const State& now = trial.state;
    return trial.dt *
               (std::max(fastest_point(unit, from.units[u].body), fastest_point(unit, now.units[u].body)) +
                std::max(fastest_moving_element(scene, from), fastest_moving_element(scene, now))) +
           tolerance::touching_gap;
}

// Obstacles that were touched at the start of the step stay near, however far the step has taken the unit.
void add_touched(const Scene& scene, std::size_t u, const State& before, const State& now,
                 std::vector<NearObstacle>& near) {
    for (const ContactLoad& load : before.units[u].contact_loads) {
        const auto place = std::lower_bound(
            near.begin(), near.end(), load.obstacle,
            [](const NearObstacle& known, std::size_t obstacle) { return known.index < obstacle; });
        if (place != near.end() && place->index == load.obstacle) continue;
        near.insert(place, {load.obstacle, placement(pose_of(scene, load.obstacle, now), now.units[u].body),
                            placement(pose_of(scene, load.obstacle, before), before.units[u].body)});
    }
}

// Does any force depend on the motion of the unit? Only friction and the forces of rate-sensitive trusses do.
bool motion_matters(const Scene& scene, const TrussMesh& mesh, const std::vector<NearObstacle>& near) {
    const bool has_friction = std::any_of(near.begin(), near.end(), [&](const NearObstacle& obstacle) {
        return scene.obstacles[obstacle.index].friction > 0.0;
    });
    const bool tires_have = !mesh.tire_nodes.empty() && scene.settings.mu_tire_barrier > 0.0 && !near.empty();
    return has_friction || tires_have || mesh.rate_sensitivity > 0.0;
}

// The unit's motion at the end of the step, seen from each near obstacle. Moving elements have their predicted
// motions for this; their own are restored afterwards.
void find_relative_motions(const Scene& scene, std::size_t u, const State& from, const Twist& motion,
                           Trial& trial) {
    std::vector<Twist>& relative = trial.skin.relative_motion;
    if (trial.state.moving_elements.empty()) return;
    const std::vector<BodyState> drifted = trial.state.moving_elements;
    predict_moving_elements(scene, from, trial.dt, trial.state);
    for (std::size_t k = 0; k < relative.size(); ++k) {
        const Twist other =
            obstacle_motion(scene, trial.skin.near[k].index, trial.state, trial.state.units[u].body);
        relative[k] = {motion.velocity - other.velocity, motion.angular_velocity - other.angular_velocity};
    }
    trial.state.moving_elements = drifted;
}

// Can nodes within a box meet the obstacle itself? `panel_bits`: their panels.
bool can_meet(const ContactPass& pass, std::uint8_t panel_bits, std::size_t k, const Box& box,
              double margin) {
    return !only_indented(pass, panel_bits, k) && within_reach(pass.shape(k), pass.near[k].now, box, margin);
}

}  // namespace

ContactPass prepare_pass(const Scene& scene, std::size_t u, const State& from, Reach reach, Trial& trial) {
    const Unit& unit = scene.vehicle->units[u];
    const UnitState& before = from.units[u];
    ContactMemory& memory = trial.skin;
    ContactPass pass{.scene = scene,
                     .unit_index = u,
                     .unit = unit,
                     .mesh = unit.trusses,
                     .before = before,
                     .now = trial.state,
                     .along_trusses = scene.settings.contact_model == ContactModel::along_truss,
                     .full_friction_speed = scene.full_friction_speed(),
                     .margin = margin_of(scene, u, from, trial)};
    const double near = before.contact_loads.empty() ? 0.0 : pass.margin;
    find_near(scene, u, from, trial.state, reach == Reach::distant ? 2.0 * pass.mesh.reach : near,
              memory.about, memory.near);
    add_touched(scene, u, from, trial.state, memory.near);
    const bool moves = motion_matters(scene, pass.mesh, memory.near);
    if (moves) pass.motion = predicted_motion(scene, u, from, trial);
    memory.relative_motion.assign(memory.near.size(), pass.motion);
    if (moves) find_relative_motions(scene, u, from, pass.motion, trial);
    memory.sums.clear(memory.near.size());
    pass.near = memory.near;
    pass.relative_motion = memory.relative_motion;
    find_indentations(pass, memory.indentations, trial.state.units[u].indented);
    return pass;
}

bool find_group_candidates(const ContactPass& pass, std::size_t g, ContactMemory& memory) {
    const BlockGroup& group = pass.before.trusses.groups[g];
    const std::uint8_t panel_bits = pass.mesh.panels_of_group[g];
    const double margin = group.touching ? pass.margin : 0.0;
    memory.group_near.clear();
    for (std::size_t k = 0; k < pass.near.size(); ++k)
        if (can_meet(pass, panel_bits, k, group.box, margin)) memory.group_near.push_back(k);
    memory.group_indentations.clear();
    for (std::size_t d = 0; d < pass.indentations.size(); ++d)
        if (gap_to_indentation(pass.indentations[d], panel_bits, group.box, group.touching, group.hangs) <
            infinity)
            memory.group_indentations.push_back(d);
    return group.touching || group.slack || !memory.group_near.empty() || !memory.group_indentations.empty();
}

void find_block_candidates(const ContactPass& pass, const ContactMemory& memory, ContactBlock& block) {
    const std::size_t b = block.index;
    const bool touching = block.start->touching;
    block.reachable.clear();
    // Where there is one obstacle, nodes that push do so on it.
    if (touching && pass.near.size() == 1 && pass.meets(b, 0)) {
        block.reachable.push_back(0);
    } else {
        for (const std::size_t k : memory.group_near)
            if (pass.meets(b, k) &&
                can_meet(pass, pass.mesh.panels_of[b], k, block.start->box, touching ? pass.margin : 0.0))
                block.reachable.push_back(k);
    }
    find_block_indentations(pass, memory.group_indentations, block);
    // A node that pushes stays a candidate of its obstacle until it is released, however far it has moved in the
    // step.
    if (touching && block.reachable.empty())
        for (std::size_t k = 0; k < pass.near.size(); ++k)
            if (pass.meets(b, k)) block.reachable.push_back(k);
}

}  // namespace birm3d
