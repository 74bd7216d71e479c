// Which nodes follow an indentation, see kernels/indentation.hpp.
#include "contact/indentation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/block_loop.hpp"
#include "birm3d/base/tolerances.hpp"
#include "contact/lagging_nodes.hpp"

namespace birm3d {

double gap_to_indentation(const IndentedPanel& indented, std::uint8_t panel_bits, const Box& box,
                          bool touching, bool hangs) {
    if ((panel_bits >> indented.panel & 1U) == 0) return infinity;
    const double gap = -most_inside(indented.indentation, box, hangs);
    if (touching && spans(indented.indentation, box, hangs)) return -infinity;
    return gap <= (touching ? indented.growth : 0.0) ? gap : infinity;
}

void find_block_indentations(const ContactPass& pass, const std::vector<std::size_t>& of_group,
                             ContactBlock& block) {
    block.indentations.clear();
    for (const std::size_t index : of_group) {
        const IndentedPanel& indented = pass.indentations[index];
        const double gap = gap_to_indentation(indented, pass.mesh.panels_of[block.index], block.start->box,
                                              block.start->touching, block.start->hangs);
        if (gap == infinity) continue;
        block.indentations.push_back({index, gap});
        if (std::find(block.reachable.begin(), block.reachable.end(), indented.near) == block.reachable.end())
            block.reachable.insert(
                std::lower_bound(block.reachable.begin(), block.reachable.end(), indented.near),
                indented.near);
    }
    std::sort(block.indentations.begin(), block.indentations.end(),
              [](const BlockIndentation& one, const BlockIndentation& other) {
                  return one.gap != other.gap ? one.gap < other.gap : one.indentation < other.indentation;
              });
}

bool only_indented(const ContactPass& pass, std::uint8_t panel_bits, std::size_t k) {
    return std::any_of(pass.indentations.begin(), pass.indentations.end(),
                       [&](const IndentedPanel& indented) {
                           return indented.near == k && pass.replaces_surface(indented) &&
                                  panel_bits == 1U << indented.panel;
                       });
}

namespace {

BIRM3D_BLOCK_LOOP void omit_panel(const BlockColumn& panel_of, double panel, BlockColumn& gap) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        gap[i] = panel_of[i] == panel ? infinity : gap[i];
}

BIRM3D_BLOCK_LOOP void note_nearest(const BlockColumn& follows, std::size_t k,
                                    std::array<std::size_t, block_size>& nearest) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        nearest[i] = follows[i] > 0.0 ? k : nearest[i];
}

// A node that follows an indentation may also touch its previous surface, as the ground below a bumper.
BIRM3D_BLOCK_LOOP void note_second(const BlockColumn& follows, const BlockColumn& gap, BlockColumn& second) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        second[i] = follows[i] > 0.0 && gap[i] < second[i] ? gap[i] : second[i];
}

BIRM3D_BLOCK_LOOP void note_released(const BlockColumn& follows, BlockColumn& released) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        released[i] = follows[i] > 0.0 ? follows[i] - 1.0 : released[i];
}

// Nodes that follow, though they lag inside a surface: the edge of a wall has carried them past its axis.
void note_lagging(const BlockColumn& follows, const BlockColumn& lags, std::bitset<block_size>& lagging) {
    for (std::size_t i = 0; i < block_size; ++i)
        if (follows[i] == 1.0 && lags[i] > 0.0) lagging.set(i);
}

// Did the node push on its nearest surface at the start of the step? Then it follows that surface through the step.
bool pushed_on_surface(const ContactPass& pass, const ContactBlock& block, std::size_t i) {
    const TrussBlockState& nodes = *block.start;
    if (!(nodes.force[i] > 0.0)) return false;
    const std::size_t k = block.reachable[block.nearest[i]];
    const Vec3 node(nodes.x[i], nodes.y[i], nodes.z[i]);
    return std::abs(nearest(pass.shape(k), pass.near[k].before.to_own(node)).gap) <= tolerance::touching_gap;
}

// Was the node inside the plane of its nearest surface as the step began? Then it did not follow that surface so far, and
// does not when it ceases to push: the surface would carry it out at once, without work of the body.
bool lags_behind_surface(const ContactPass& pass, const ContactBlock& block, std::size_t i) {
    const TrussBlockState& nodes = *block.start;
    if (!(block.faces.gap[i] <= 0.0)) return false;
    return lags_behind(gap_as_step_began(pass.near[block.reachable[block.nearest[i]]],
                                         {nodes.x[i], nodes.y[i], nodes.z[i]}, block.contact.normal(i),
                                         block.faces.gap[i]));
}

// Is any of the block's indentations that of a wall's edge?
bool any_edge(const ContactPass& pass, const ContactBlock& block) {
    return std::any_of(
        block.indentations.begin(), block.indentations.end(), [&](const BlockIndentation& reached) {
            const Obstacle& obstacle = pass.obstacle(pass.indentations[reached.indentation].near);
            return obstacle.top_edge || std::get<Post>(obstacle.shape).opens;
        });
}

// For each node of a block: what follow_indentation() asks about the surface that the node touches.
struct HoldingSurfaces {
    alignas(64) BlockColumn contact_gap, least_facing, lags;
    alignas(64) BlockColumn lags_pushing;  // the same, of pushing nodes alone
};

// Cosine of a surface's normal and a panel's direction above which the surface holds a node of the panel. The flank of another
// post does so at any angle. A bumper slides along the ground below it, which does not hold it.
constexpr double holding_cosine_post = -1.0, holding_cosine_other = 0.5;

// The gap alone does not tell whether a node is in contact: a surface recedes from a node that pushes on it, by more in a longer
// step.
void find_holding_surfaces(const ContactPass& pass, const ContactBlock& block, HoldingSurfaces& holding) {
    const bool may_lag = any_edge(pass, block);
    for (std::size_t i = 0; i < block_size; ++i) {
        const double gap = block.faces.gap[i];
        const bool lags = may_lag && lags_behind_surface(pass, block, i);
        const bool touches =
            gap <= tolerance::touching_gap || (gap <= pass.margin && pushed_on_surface(pass, block, i));
        holding.lags[i] = lags ? 1.0 : 0.0;
        holding.lags_pushing[i] = lags && block.start->force[i] > 0.0 ? 1.0 : 0.0;
        holding.contact_gap[i] = touches && !lags ? gap : infinity;
        const bool on_post = std::holds_alternative<Post>(pass.shape(block.reachable[block.nearest[i]]));
        holding.least_facing[i] = on_post ? holding_cosine_post : holding_cosine_other;
    }
}

}  // namespace

void omit_indented(const ContactPass& pass, std::size_t b, std::size_t k, NearestOfBlock& found) {
    for (const IndentedPanel& indented : pass.indentations)
        if (indented.near == k && pass.replaces_surface(indented) &&
            (pass.mesh.panels_of[b] >> indented.panel & 1U) != 0)
            omit_panel(pass.mesh.block[b].panel, static_cast<double>(indented.panel), found.gap);
}

void follow_indentations(const ContactPass& pass, ContactBlock& block) {
    block.released.fill(0.0);
    if (block.indentations.empty()) return;
    alignas(64) BlockColumn follows, rank;
    HoldingSurfaces holding;
    find_holding_surfaces(pass, block, holding);
    rank.fill(infinity);
    const TrussBlock& trusses = pass.mesh.block[block.index];
    for (const BlockIndentation& reached : block.indentations) {
        const IndentedPanel& indented = pass.indentations[reached.indentation];
        const bool first = reached.indentation == block.indentations.front().indentation;
        if (!first &&
            reached.gap > furthest_off(*block.start, trusses.panel, indented.panel, block.faces.gap))
            continue;
        alignas(64) const BlockColumn gap = block.faces.gap;
        follow_indentation(indented.indentation, indented.before, *block.start, trusses, indented.panel,
                           holding.contact_gap, holding.least_facing,
                           indented.indentation.is_face ? holding.lags : holding.lags_pushing, block.faces,
                           block.contact, rank, follows);
        note_second(follows, gap, block.second_gap);
        note_released(follows, block.released);
        note_lagging(follows, holding.lags_pushing, block.lagging);
        block.hangs = block.hangs || (indented.indentation.is_face && block_max(follows) > 0.0);
        const auto reachable = std::find(block.reachable.begin(), block.reachable.end(), indented.near) -
                               block.reachable.begin();
        if (block.reachable.size() > 1)
            note_nearest(follows, static_cast<std::size_t>(reachable), block.nearest);
    }
}

}  // namespace birm3d
