// Posts that dent the skin: see kernels/dent.hpp.
#include <algorithm>
#include <array>
#include <limits>

#include "birm3d/sim/obstacles.hpp"
#include "birm3d/sim/panel_dents.hpp"
#include "sim/skin.hpp"

namespace birm3d {

void Skin::find_dents() {
    if (mesh_.dent_reach == 0.0) return;
    for (std::size_t k = 0; k < near_.size(); ++k) {
        if (!std::holds_alternative<Post>(scene_.obstacles[near_[k].index].shape)) continue;
        const Dented dented = dents_of(k);
        if ((dented.panels | dented.passed) != 0) now_.dented.push_back(dented);
    }
}

// Which panels does the post dent? Those that it comes into from in front, until it has let go of them.
Dented Skin::dents_of(std::size_t k) {
    const std::size_t obstacle = near_[k].index;
    const Post& post = std::get<Post>(scene_.obstacles[obstacle].shape);
    const auto known = std::find_if(before_.dented.begin(), before_.dented.end(),
                                    [=](const Dented& d) { return d.obstacle == obstacle; });
    const Dented last = known != before_.dented.end() ? *known : Dented{obstacle};
    const bool pushes = std::any_of(before_.touches.begin(), before_.touches.end(), [=](const Touch& touch) {
        return touch.obstacle == obstacle && touch.normal_force > 0.0;
    });
    Dented now{obstacle};
    for (std::size_t p = 0; p < panels; ++p) {
        const Panel& panel = mesh_.panel[p];
        const auto bit = static_cast<std::uint8_t>(1U << p);
        const bool dents = (last.panels & bit) != 0, passed = (last.passed & bit) != 0;
        if (!panel.any || !stands_across(near_[k].now, panel, dents)) continue;
        const Dent dent(post, near_[k].now, panel, mesh_.dent_reach);
        if (!dents && !(dent.beside(panel) < 0.0)) continue;
        if (!dents && dent.is_beyond(panel)) {
            now.passed |= bit;
            continue;
        }
        // How far in a post can have come within the step, and nodes off its dent; of one that was in before, does it
        // touch?
        const double way = 2.0 * margin_ * dent.fastest_growth(panel);
        const double deepest = dents || passed ? 0.0 : way;
        const double gap = dents && pushes ? 0.0 : gap_of_panel(dent, p, mesh_, before_, 0.0, -deepest);
        if (gap > 0.0) continue;
        if (dents || (!passed && (gap > -deepest || was_before(k, p)))) {
            now.panels |= bit;
            dents_.push_back({k, p, dent, way});
        } else {
            now.passed |= bit;
        }
    }
    return now;
}

// Did the post stand in front of the panel an instant before?
bool Skin::was_before(std::size_t k, std::size_t p) {
    const Post& post = std::get<Post>(scene_.obstacles[near_[k].index].shape);
    const Panel& panel = mesh_.panel[p];
    const Dent then(post, near_[k].before, panel, mesh_.dent_reach);
    return then.beside(panel) < 0.0 && gap_of_panel(then, p, mesh_, before_, 0.0, 0.0) > 0.0;
}

// Which dents can reach the block? Their posts are among what it sees, then. What pushes stays at its dent until it is
// released: of a block that touches, a dent counts that its nodes can have come off within the step.
bool Skin::find_dents_of_block(std::size_t b) {
    block_dents_.clear();
    for (std::size_t d = 0; d < dents_.size(); ++d) {
        const DentedPanel& dented = dents_[d];
        if ((mesh_.panels_of[b] >> dented.panel & 1U) == 0) continue;
        const double off = from(b).touching ? dented.way : 0.0;
        const double gap = -most_inside(dented.dent, box_);
        if (gap > off) continue;
        block_dents_.push_back({d, gap});
        if (std::find(seen_.begin(), seen_.end(), dented.near) == seen_.end())
            seen_.insert(std::lower_bound(seen_.begin(), seen_.end(), dented.near), dented.near);
    }
    std::sort(block_dents_.begin(), block_dents_.end(), [](const BlockDent& x, const BlockDent& y) {
        return x.gap != y.gap ? x.gap < y.gap : x.dent < y.dent;
    });
    return !block_dents_.empty();
}

// Are all nodes of some panels, bit by bit, on one that this post dents?
bool Skin::is_left_to_dents(std::uint8_t of, std::size_t near) const {
    return std::any_of(dents_.begin(), dents_.end(), [&](const DentedPanel& dented) {
        return dented.near == near && of == 1U << dented.panel;
    });
}

namespace {

BIRM3D_LANE_LOOP void leave_out(const Lanes& panel_of, double panel, Lanes& gap) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        gap[i] = panel_of[i] == panel ? std::numeric_limits<double>::infinity() : gap[i];
}

}  // namespace

// Nodes of a panel that a post dents do not see the post itself, near or far.
void Skin::leave_to_dents(std::size_t b, std::size_t near, NearestLanes& found) const {
    for (const DentedPanel& dented : dents_)
        if (dented.near == near && (mesh_.panels_of[b] >> dented.panel & 1U) != 0)
            leave_out(mesh_.block[b].panel, static_cast<double>(dented.panel), found.gap);
}

namespace {

// Nodes of the panel to which this dent is nearer than what they have seen so far hang on it, unless it would draw them
// into that: a post that came past the panel's edge stands behind them.
BIRM3D_LANE_LOOP void take_nearer(const DentLanes& dent, const Lanes& panel_of, double panel, double into_x,
                                  double into_y, double into_z, std::size_t seen, NodeFaces& faces,
                                  BlockContact& contact, std::array<std::size_t, lanes>& nearest) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double against = contact.nx[i] * into_x + contact.ny[i] * into_y + contact.nz[i] * into_z;
        const bool barred = against < 0.0 && faces.gap[i] - against * dent.gap[i] < 0.0;
        const bool takes = panel_of[i] == panel && dent.gap[i] < faces.gap[i] && !barred;
        nearest[i] = takes ? seen : nearest[i];
        faces.gap[i] = takes ? dent.gap[i] : faces.gap[i];
        faces.per_force[i] = takes ? dent.per_force[i] : faces.per_force[i];
        faces.bx[i] = takes ? into_x : faces.bx[i];
        faces.by[i] = takes ? into_y : faces.by[i];
        faces.bz[i] = takes ? into_z : faces.bz[i];
        contact.nx[i] = takes ? dent.nx[i] : contact.nx[i];
        contact.ny[i] = takes ? dent.ny[i] : contact.ny[i];
        contact.nz[i] = takes ? dent.nz[i] : contact.nz[i];
        contact.px[i] = takes ? dent.px[i] : contact.px[i];
        contact.py[i] = takes ? dent.py[i] : contact.py[i];
        contact.pz[i] = takes ? dent.pz[i] : contact.pz[i];
        contact.tx[i] = takes ? dent.tx[i] : contact.tx[i];
        contact.ty[i] = takes ? dent.ty[i] : contact.ty[i];
        contact.tz[i] = takes ? dent.tz[i] : contact.tz[i];
    }
}

}  // namespace

void Skin::draw_in(std::size_t b, const TrussBlockState& block) {
    alignas(64) DentLanes found;
    for (const BlockDent& reached : block_dents_) {
        const DentedPanel& dented = dents_[reached.dent];
        const OfPanel of{mesh_.block[b].panel, dented.panel, faces_.gap};
        if (reached.dent != block_dents_.front().dent && reached.gap > furthest_off(block, of)) continue;
        const Vec3& into = dented.dent.into;
        dent_of(dented.dent, block, of, found);
        const auto seen = std::find(seen_.begin(), seen_.end(), dented.near) - seen_.begin();
        take_nearer(found, mesh_.block[b].panel, static_cast<double>(dented.panel), into.x(), into.y(),
                    into.z(), static_cast<std::size_t>(seen), faces_, contact_, nearest_);
    }
}

}  // namespace birm3d
