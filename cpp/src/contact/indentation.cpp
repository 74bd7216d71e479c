// Posts that dent the skin: see kernels/dent.hpp.
#include <algorithm>
#include <array>
#include <limits>

#include "birm3d/scene/indentation_gaps.hpp"
#include "birm3d/scene/obstacles.hpp"
#include "contact/contact_pass.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

void Skin::find_dents() {
    if (mesh_.dent_reach == 0.0) return;
    for (std::size_t k = 0; k < near_.size(); ++k) {
        if (!std::holds_alternative<Post>(scene_.obstacles[near_[k].index].shape)) continue;
        const Dented dented = dents_of(k);
        if ((dented.panels | dented.passed) != 0) now_.dented.push_back(dented);
    }
    for (const Dented& before : before_.dented)
        dented_ |= before.panels;
    if (dented_ == 0) return;
    furthest_ = 2.0 * margin_;
    for (const DentedPanel& dented : dents_)
        furthest_ = std::max(furthest_, dented.way);
}

// Which panels does the post dent? Those that it comes into from in front, until it has let go of them.
Dented Skin::dents_of(std::size_t k) {
    const std::size_t obstacle = near_[k].index;
    const Post& post = std::get<Post>(scene_.obstacles[obstacle].shape);
    const auto known = std::find_if(before_.dented.begin(), before_.dented.end(),
                                    [=](const Dented& d) { return d.obstacle == obstacle; });
    const Dented last = known != before_.dented.end() ? *known : Dented{obstacle};
    const bool pushes = std::any_of(
        before_.contact_loads.begin(), before_.contact_loads.end(),
        [=](const ContactLoad& touch) { return touch.obstacle == obstacle && touch.normal_force > 0.0; });
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
            dents_.push_back({k, p, dent, Dent(post, near_[k].before, panel, mesh_.dent_reach), way});
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

// How near can nodes of some panels, bit by bit, within a box come to a dent (m)? Infinite where it can not reach them.
// What pushes stays at its dent until it is released: it can have come off within the step.
double Skin::reach_of_dent(const DentedPanel& dented, std::uint8_t of, const Box& box, bool touching) const {
    if ((of >> dented.panel & 1U) == 0) return infinity;
    const double gap = -most_inside(dented.dent, box);
    if (touching && spans(dented.dent, box)) return -infinity;
    return gap <= (touching ? dented.way : 0.0) ? gap : infinity;
}

// Which dents can reach the block? Their posts are among what it sees, then.
bool Skin::find_dents_of_block(std::size_t b) {
    block_dents_.clear();
    for (const std::size_t d : group_dents_) {
        const double gap = reach_of_dent(dents_[d], mesh_.panels_of[b], from(b).box, from(b).touching);
        if (gap == infinity) continue;
        block_dents_.push_back({d, gap});
        const std::size_t near = dents_[d].near;
        if (std::find(seen_.begin(), seen_.end(), near) == seen_.end())
            seen_.insert(std::lower_bound(seen_.begin(), seen_.end(), near), near);
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
        gap[i] = panel_of[i] == panel ? infinity : gap[i];
}

}  // namespace

// Nodes of a panel that a post dents do not see the post itself, near or far.
void Skin::leave_to_dents(std::size_t b, std::size_t near, NearestLanes& found) const {
    for (const DentedPanel& dented : dents_)
        if (dented.near == near && (mesh_.panels_of[b] >> dented.panel & 1U) != 0)
            leave_out(mesh_.block[b].panel, static_cast<double>(dented.panel), found.gap);
}

namespace {

BIRM3D_LANE_LOOP void note_nearest(const Lanes& hangs, std::size_t seen,
                                   std::array<std::size_t, lanes>& nearest) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        nearest[i] = hangs[i] > 0.0 ? seen : nearest[i];
}

// What a node stood at before it came to hang on a dent can hold it as well: the ground below a bumper.
BIRM3D_LANE_LOOP void note_second(const Lanes& hangs, const Lanes& gap, Lanes& second) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        second[i] = hangs[i] > 0.0 && gap[i] < second[i] ? gap[i] : second[i];
}

BIRM3D_LANE_LOOP void note_let_go(const Lanes& hangs, Lanes& let_go) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        let_go[i] = hangs[i] > 0.0 ? hangs[i] - 1.0 : let_go[i];
}

}  // namespace

void Skin::draw_in(std::size_t b, const TrussBlockState& block) {
    alignas(64) Lanes hangs, rank;
    let_go_.fill(0.0);
    rank.fill(infinity);
    for (const BlockDent& reached : block_dents_) {
        const DentedPanel& dented = dents_[reached.dent];
        const Lanes& panel_of = mesh_.block[b].panel;
        if (reached.dent != block_dents_.front().dent &&
            reached.gap > furthest_off(block, panel_of, dented.panel, faces_.gap))
            continue;
        alignas(64) const Lanes gap = faces_.gap;
        hang_on(dented.dent, dented.then, block, panel_of, dented.panel, faces_, contact_, rank, hangs);
        note_second(hangs, gap, second_gap_);
        note_let_go(hangs, let_go_);
        const auto seen = std::find(seen_.begin(), seen_.end(), dented.near) - seen_.begin();
        if (seen_.size() > 1) note_nearest(hangs, static_cast<std::size_t>(seen), nearest_);
    }
}

}  // namespace birm3d
