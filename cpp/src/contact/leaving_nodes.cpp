#include "contact/leaving_nodes.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "base/block_loop.hpp"
#include "kernels/indentation.hpp"
#include "scene/indentation_gaps.hpp"

namespace birm3d {

namespace {

// How far each node that pushed has followed a receding surface, or its truss has extended: the greater of both (m).
BIRM3D_BLOCK_LOOP void find_recessions(const TrussBlockState& last, const TrussBlockState& next,
                                       const BlockContact& contact, BlockColumn& recession) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double extension = last.deflection[i] - next.deflection[i];
        const double motion = contact.nx[i] * (last.x[i] - next.x[i]) +
                              contact.ny[i] * (last.y[i] - next.y[i]) +
                              contact.nz[i] * (last.z[i] - next.z[i]);
        recession[i] = last.force[i] > 0.0 ? (motion > extension ? motion : extension) : 0.0;
    }
}

// How far each node that pushed is from what it would follow now, at least (m).
void find_distances(const ContactBlock& block, BlockColumn& distance) {
    find_recessions(*block.start, *block.end, block.contact, distance);
    if (block.indentations.empty()) return;
    // A truss that ends on the way to a surface hides how far that is.
    for (std::size_t i = 0; i < block_size; ++i)
        if (block.start->force[i] > 0.0 && !(block.faces.per_force[i] > 0.0))
            distance[i] = std::max(distance[i], block.faces.gap[i]);
}

// What indentations hold the nodes of a block as the step begins.
struct StartOfStep {
    NodeFaces faces;
    BlockContact contact;
    std::array<std::optional<std::size_t>, block_size> by;  // index in ContactPass::near of the obstacle
    alignas(64) BlockColumn rank, free, nothing, any_facing;
};

// Adds what the k-th obstacle indented of panel `p`.
void add_start(const ContactPass& pass, std::size_t b, std::size_t k, std::size_t p, double behind,
               StartOfStep& start) {
    Indentation then = indentation_by(pass.obstacle(k), pass.near[k].before, pass.mesh.panel[p], pass.mesh,
                                      pass.scene.settings);
    then.stay_behind(behind);
    alignas(64) BlockColumn follows;
    follow_indentation(then, then, pass.before.trusses.block[b], pass.mesh.block[b], p, start.free,
                       start.any_facing, start.nothing, start.faces, start.contact, start.rank, follows);
    for (std::size_t i = 0; i < block_size; ++i)
        if (follows[i] > 0.0) start.by[i] = follows[i] == 1.0 ? std::optional(k) : std::nullopt;
}

// `free`: no surface but these indentations holds a node.
void find_start(const ContactPass& pass, std::size_t b, StartOfStep& start) {
    for (BlockColumn* column : {&start.faces.gap, &start.rank, &start.free})
        column->fill(infinity);
    for (BlockColumn* column : {&start.faces.per_force, &start.nothing, &start.any_facing})
        column->fill(0.0);
    start.contact.set_normal(Vec3::UnitX());
    for (const IndentedPanels& indented : pass.before.indented)
        for (std::size_t k = 0; k < pass.near.size(); ++k)
            for (std::size_t p = 0; p < panels && pass.near[k].index == indented.obstacle; ++p)
                if ((indented.panels & pass.mesh.panels_of[b]) >> p & 1)
                    add_start(pass, b, k, p, indented.behind[p], start);
}

}  // namespace

bool was_indented(const ContactPass& pass, const ContactBlock& block) {
    return (pass.mesh.panels_of[block.index] & pass.indented_before) != 0;
}

void find_leaving(const ContactPass& pass, const ContactBlock& block, BlockColumn& leaves) {
    leaves.fill(0.0);
    if (!was_indented(pass, block)) return;
    alignas(64) BlockColumn distance;
    find_distances(block, distance);
    for (std::size_t i = 0; i < block_size; ++i) {
        const double panel = pass.mesh.block[block.index].panel[i];
        const bool on_indented =
            panel >= 0.0 && (pass.indented_before >> static_cast<unsigned>(panel) & 1U) != 0;
        const bool released = !block.indentations.empty() && block.released[i] > 0.0;
        const bool follows = !block.indentations.empty() && block.faces.per_force[i] > 0.0;
        const double farthest = follows ? pass.greatest_following : 2.0 * pass.margin;
        leaves[i] = released || (on_indented && distance[i] > farthest) ? 1.0 : 0.0;
    }
}

void find_work_until_leaving(const ContactPass& pass, const ContactBlock& block, BlockColumn& work) {
    work.fill(0.0);
    StartOfStep start{};
    find_start(pass, block.index, start);
    const TrussBlockState& nodes = pass.before.trusses.block[block.index];
    for (std::size_t i = 0; i < block_size; ++i) {
        if (!start.by[i] || !(nodes.force[i] > 0.0)) continue;
        const Vec3 arm =
            anchor_of(pass.mesh.block[block.index], i) - Vec3(nodes.x[i], nodes.y[i], nodes.z[i]);
        const Vec3 direction(start.faces.bx[i], start.faces.by[i], start.faces.bz[i]);
        const double share = std::max(0.0, arm.normalized().dot(direction)) * start.faces.per_force[i];
        const NearObstacle& near = pass.near[*start.by[i]];
        const Vec3 place = start.contact.places()[i];
        const Vec3 way = near.now.from_own(near.before.to_own(place)) - place;
        work[i] = 0.5 * nodes.force[i] * share * start.contact.normal(i).dot(way);
    }
}

}  // namespace birm3d
