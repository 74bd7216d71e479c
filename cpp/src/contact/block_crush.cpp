#include "contact/block_crush.hpp"

#include <algorithm>
#include <optional>

#include "contact/contact_loads.hpp"
#include "contact/nearest_surface.hpp"
#include "contact/released_nodes.hpp"
#include "contact/stopping_face.hpp"

namespace birm3d {

namespace {

PlaneSums& sums_of_plane(const ContactPass& pass, std::size_t k, const HalfSpace& plane,
                         std::vector<PlaneSums>& planes) {
    for (PlaneSums& known : planes)
        if (known.near == k && known.surface.face.normal == plane.normal) return known;
    const NearObstacle& near = pass.near[k];
    HalfSpace before = plane;
    before.normal = near.before.rotation.transpose() * (near.now.rotation * plane.normal);
    planes.push_back({k, FlatContact(pass.unit.body, plane, before), {}});
    return planes.back();
}

// `at`: the obstacle that the nodes meet, or several_obstacles.
void find_rate_factor(const ContactPass& pass, const ContactBlock& block, std::size_t at,
                      const Places& places, BlockColumn& factor) {
    const auto set = [&](const Twist& motion, BlockColumn& to) {
        set_rate_factor(pass.mesh.rate_sensitivity, block.end->force, motion, places, block.contact, to);
    };
    if (at != several_obstacles) return set(pass.relative_motion[at], factor);
    if (pass.now.moving_elements.empty()) return set(pass.motion, factor);
    alignas(64) BlockColumn factor_of_obstacle;
    for (std::size_t k = 0; k < block.reachable.size(); ++k) {
        set(pass.relative_motion[block.reachable[k]], factor_of_obstacle);
        for (std::size_t i = 0; i < block_size; ++i)
            if (block.nearest[i] == k) factor[i] = factor_of_obstacle[i];
    }
}

// The rate of deflection depends on where the nodes will be. Therefore a rate-sensitive block is first crushed
// without the rate factor.
template <class Crush>
bool crush_with_rate(const ContactPass& pass, const ContactBlock& block, std::size_t at, const Places& places,
                     CrushSums& sums, const Crush& crush) {
    if (pass.mesh.rate_sensitivity == 0.0) return crush(nullptr, sums);
    CrushSums without;
    crush(nullptr, without);
    alignas(64) BlockColumn factor;
    find_rate_factor(pass, block, at, places, factor);
    return crush(&factor, sums);
}

// Returns whether any node ceased to push.
bool crush_on(const ContactPass& pass, const PlaneSums& plane, ContactBlock& block, CrushSums& to) {
    return crush_with_rate(pass, block, plane.near, {block.end->x, block.end->y, block.end->z}, to,
                           [&](const BlockColumn* factor, CrushSums& sums) {
                               return crush(plane.surface, pass.mesh, block.index, factor, *block.start,
                                            *block.end, block.contact, sums);
                           });
}

// The same; `at`: the obstacle that the nodes meet, or several_obstacles.
bool crush_on(const ContactPass& pass, std::size_t at, ContactBlock& block, CrushSums& to) {
    for (const Corner& corner : block.corners)
        to.released_work += corner.lost_work;
    return crush_with_rate(pass, block, at, block.contact.places(), to,
                           [&](const BlockColumn* factor, CrushSums& sums) {
                               return crush(block.faces, pass.unit.body, pass.mesh, block.index, factor,
                                            *block.start, *block.end, block.contact, sums);
                           });
}

// The obstacle that all nodes in contact meet, or several_obstacles. A node is in contact if it pushes or is inside.
std::size_t obstacle_met(const ContactBlock& block) {
    if (block.reachable.size() == 1) return block.reachable[0];
    std::optional<std::size_t> only;
    for (std::size_t i = 0; i < block_size; ++i) {
        if (!(block.start->force[i] > 0.0 || block.faces.gap[i] < 0.0)) continue;
        if (only && *only != block.nearest[i]) return several_obstacles;
        only = block.nearest[i];
    }
    return block.reachable[only.value_or(0)];
}

void add_friction_and_distribute(const ContactPass& pass, std::size_t at, ContactBlock& block,
                                 ContactSums& sums) {
    if (!block.end->touching) return;
    if (at != several_obstacles)
        apply_friction(pass, at, block.contact.places(), block.contact, block, sums);
    else
        distribute_loads(pass, block, sums);
}

// Puts the nodes back to where they were at the start of the step. A corner has moved some of them already; an
// indentation would move those by the post's motion a second time.
void restart(const ContactPass& pass, ContactBlock& block) {
    block.begin(block.index, pass.before.trusses.block[block.index], *block.end);
    snap_back(pass, block);
}

// Crushes the block anew from where other surfaces have stopped the released nodes.
void crush_stopped(const ContactPass& pass, ContactState& state) {
    restart(pass, state.block);
    stop_nodes(pass, state.block, state.sums);
    find_nearest_surface(pass, state.block);
    stand_on_stopping_faces(pass, state.block);
    crush_on(pass, several_obstacles, state.block, state.sums.several);
    add_friction_and_distribute(pass, several_obstacles, state.block, state.sums);
}

}  // namespace

PlaneSums* only_plane(const ContactPass& pass, const ContactBlock& block, ContactSums& sums) {
    const std::vector<std::size_t>& reachable = block.reachable;
    if (reachable.empty() || !block.indentations.empty() || block.start->may_lag()) return nullptr;
    const bool known =
        reachable.size() == 1 && !sums.planes.empty() && sums.planes.back().near == reachable[0];
    if (known && std::holds_alternative<HalfSpace>(pass.shape(reachable[0])))
        return &sums.planes.back();  // the same plane to all blocks
    const auto element_of = [&](std::size_t k) { return pass.scene.obstacles[pass.near[k].index].element; };
    for (const std::size_t k : reachable)
        if (element_of(k) != element_of(reachable[0])) return nullptr;
    for (const std::size_t k : reachable) {
        const auto plane = flat_part(pass.shape(k), pass.near[k].now, block.start->box);
        if (!plane) continue;
        const bool before_all = std::all_of(reachable.begin(), reachable.end(), [&](std::size_t other) {
            return other == k || is_behind(*plane, pass.shape(other), pass.near[other].now);
        });
        if (before_all) return &sums_of_plane(pass, k, *plane, sums.planes);
    }
    return nullptr;
}

void crush_on_plane(const ContactPass& pass, PlaneSums& plane, ContactState& state) {
    ContactBlock& block = state.block;
    const Vec3& normal = plane.surface.face.normal;
    if (!block.flat_normal || *block.flat_normal != normal)
        block.contact.set_normal(block.flat_normal.emplace(normal));
    const bool ceased = crush_on(pass, plane, block, plane.sums);
    if (may_release(pass, block, ceased) && find_stopped(pass, &plane.surface, block, state.distant)) {
        CrushSums undone;
        crush_on(pass, plane, block, undone);
        plane.sums -= undone;
        return crush_stopped(pass, state);
    }
    if (block.end->touching)
        apply_friction(pass, plane.near, {block.end->x, block.end->y, block.end->z}, block.contact, block,
                       state.sums);
}

void crush_on_surfaces(const ContactPass& pass, ContactState& state) {
    ContactBlock& block = state.block;
    // A node that moves into one obstacle may reach another one, too. Posts are too far apart for that.
    const bool may_enter_another =
        std::any_of(block.reachable.begin(), block.reachable.end(),
                    [&](std::size_t k) { return std::holds_alternative<Prism>(pass.shape(k)); });
    const bool fixed = block.corners.empty() && (block.reachable.size() == 1 || !may_enter_another);
    const std::size_t at = fixed ? obstacle_met(block) : several_obstacles;
    CrushSums& to = at != several_obstacles ? state.sums.obstacles[at].sums : state.sums.several;
    const bool ceased = crush_on(pass, at, block, to);
    if (may_release(pass, block, ceased) && find_stopped(pass, nullptr, block, state.distant)) {
        CrushSums undone;
        crush_on(pass, at, block, undone);
        to -= undone;
        return crush_stopped(pass, state);
    }
    add_friction_and_distribute(pass, at, block, state.sums);
}

}  // namespace birm3d
