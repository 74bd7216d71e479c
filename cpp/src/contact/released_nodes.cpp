// Nodes that a surface lets go. The truss of such a node drives it off the surface, outwards along itself, until it has
// its residual length or another surface stops it. On that way nothing outside does work: what the truss loses is lost.
#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/scene/obstacles.hpp"
#include "contact/contact_pass.hpp"

namespace birm3d {

namespace {

// Of two points on the way this far apart, a surface between them is seen (m).
constexpr double least_stride = 2e-3;

// Greatest way of a node that pushed, along its truss (m).
BIRM3D_LANE_LOOP double furthest_outwards(const TrussBlockState& last, const TrussBlockState& next) {
    alignas(64) Lanes way;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        way[i] = last.force[i] > 0.0 ? last.deflection[i] - next.deflection[i] : 0.0;
    return lane_max(way);
}

}  // namespace

// The block at hand as the step finds it, to be altered.
TrussBlockState& Skin::altered(std::size_t b) {
    if (!sprung_back_) sprung_ = before_.trusses.block[b];
    sprung_back_ = true;
    return sprung_;
}

// Can an obstacle stop the node itself? Nodes of a panel that it dents hang on the dent.
bool Skin::is_solid_to(std::size_t b, std::size_t i, std::size_t near) const {
    if (!meets(b, near)) return false;
    return std::none_of(dents_.begin(), dents_.end(), [&](const DentedPanel& dented) {
        return dented.near == near && mesh_.block[b].panel[i] == static_cast<double>(dented.panel);
    });
}

// Obstacles that a node may spring to, though nothing of the vehicle is near to them yet.
void Skin::look_further() {
    if (looked_further_) return;
    looked_further_ = true;
    std::vector<std::size_t> about;
    scene_.map.find(now_.body.position, 2.0 * mesh_.reach, about);
    for (const std::size_t i : about) {
        if (i == scene_.ground && !scene_.skin_meets_ground[u_]) continue;
        const bool known = std::any_of(near_.begin(), near_.end(),
                                       [i](const NearObstacle& near) { return near.index == i; });
        if (!known) further_.push_back({i, placement(pose_of(scene_, i, trial_.state), now_.body), {}});
    }
}

// Where the first surface on the way of a node stops it; none where the way is free.
std::optional<Vec3> Skin::stop_on_way(std::size_t b, std::size_t i, const Vec3& start,
                                      const Vec3& end) const {
    const Vec3 way = end - start;
    const double length = way.norm();
    const auto gap_at = [&](double share, double enough) {
        const Vec3 place = start + share * way;
        double least = enough;
        for (const NearObstacle& other : further_)
            if (other.index != scene_.ground || b < mesh_.shell_blocks)
                least = std::min(least,
                                 nearest(scene_.obstacles[other.index].shape, other.now.to_own(place)).gap);
        for (std::size_t k = 0; k < near_.size(); ++k)
            if (is_solid_to(b, i, k))
                least = std::min(least, nearest(near_shape(k), near_[k].now.to_own(place)).gap);
        return least;
    };
    double outside = 0.0, gap = gap_at(0.0, length);
    if (gap < -tolerance::touching_gap) return start;
    // Nothing is nearer than the gap: that far the way is free.
    while (gap >= -tolerance::touching_gap) {
        if (outside >= 1.0) return std::nullopt;
        const double next = std::min(1.0, outside + std::max(gap, least_stride) / length);
        gap = gap_at(next, length);
        if (gap >= -tolerance::touching_gap) {
            outside = next;
            continue;
        }
        double inside = next;
        constexpr int halvings = 40;
        for (int n = 0; n < halvings && (inside - outside) * length > 1e-12; ++n) {
            const double middle = 0.5 * (outside + inside);
            (gap_at(middle, length) >= 0.0 ? outside : inside) = middle;
        }
    }
    return start + outside * way;
}

// Has a dent let the node go, or gone from under it at once, as where its post comes to lie across the panel? No motion of
// the step takes it as far outwards as it stands now.
bool Skin::springs_off(std::size_t b, std::size_t i) const {
    if (!block_dents_.empty() && let_go_[i] > 0.0) return true;
    const TrussBlockState &last = from(b), &next = now_.trusses.block[b];
    if (!(last.force[i] > 0.0 && last.deflection[i] - next.deflection[i] > furthest_)) return false;
    const double panel = mesh_.block[b].panel[i];
    return panel >= 0.0 && (dented_ >> static_cast<unsigned>(panel) & 1U) != 0;
}

// Any node of the block?
bool Skin::springs_off(std::size_t b) const {
    if ((mesh_.panels_of[b] & dented_) == 0) return false;
    const TrussBlockState &last = from(b), &next = now_.trusses.block[b];
    alignas(64) Lanes let_go = let_go_;
    return (!block_dents_.empty() && lane_max(let_go) > 0.0) || furthest_outwards(last, next) > furthest_;
}

// Finds the nodes that are let go and that another surface stops on their way. `plane` lets them go, or, where it is null,
// the faces at hand. Nodes that spring off a dent stop where they stand now. Are there any of either?
bool Skin::find_stopped(std::size_t b, const FlatContact* plane) {
    stopped_.clear();
    const TrussBlock& truss = mesh_.block[b];
    const TrussBlockState &last = from(b), &next = now_.trusses.block[b];
    for (std::size_t i = 0; i < lanes; ++i) {
        if (dented_ != 0 && springs_off(b, i)) {
            stopped_.push_back({i, Vec3(next.x[i], next.y[i], next.z[i]), next.deflection[i],
                                next.residual[i], next.peak_deflection[i],
                                std::max(0.0, next.unloading[i] * (next.deflection[i] - next.residual[i])),
                                0.0});
            continue;
        }
        if (!(last.force[i] > 0.0 && next.force[i] == 0.0)) continue;
        if (plane == nullptr && faces_.per_force[i] > 0.0) continue;  // a dent keeps it
        const Vec3 anchor(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
        const Vec3 to(next.x[i], next.y[i], next.z[i]), was(last.x[i], last.y[i], last.z[i]);
        // The face held it to the end of the step, but where it moved off by itself: see release() in crush_rows.cpp.
        const Vec3 held =
            plane != nullptr ? Vec3(was - (plane->face.normal.dot(was) - plane->face.offset) * plane->holding)
                             : Vec3(contact_.px[i], contact_.py[i], contact_.pz[i]);
        const Vec3 n = plane != nullptr ? plane->face.normal : contact_.normal(i);
        if ((anchor - held).dot(n) > 0.0 || (to - held).norm() <= tolerance::touching_gap) continue;
        look_further();
        const auto stop = stop_on_way(b, i, held, to);
        if (!stop) continue;
        overlooks_ =
            overlooks_ || std::any_of(further_.begin(), further_.end(), [&](const NearObstacle& other) {
                return nearest(scene_.obstacles[other.index].shape, other.now.to_own(*stop)).gap <
                       least_stride;
            });
        const double deflection = truss.length[i] - (*stop - anchor).norm();
        const double let_go = truss.length[i] - (held - anchor).norm();
        stopped_.push_back({i, *stop, deflection, next.residual[i], next.peak_deflection[i],
                            std::max(0.0, next.unloading[i] * (deflection - next.residual[i])),
                            0.5 * last.force[i] * (let_go - last.deflection[i])});
    }
    return !stopped_.empty() && !overlooks_;
}

// Alters the block so that nodes stand where they were stopped; what is there is seen. The work on their trusses up to
// their release was done all the same.
void Skin::stop(std::size_t b) {
    TrussBlockState& block = altered(b);
    block.touching = true;
    for (const Stopped& node : stopped_) {
        block.unloading[node.lane] = now_.trusses.block[b].unloading[node.lane];
        block.x[node.lane] = node.place.x();
        block.y[node.lane] = node.place.y();
        block.z[node.lane] = node.place.z();
        block.deflection[node.lane] = node.deflection;
        block.residual[node.lane] = node.residual;
        block.peak_deflection[node.lane] = node.peak_deflection;
        block.force[node.lane] = node.force;
        shared_.released_work += node.work;
        for (std::size_t k = 0; k < near_.size(); ++k) {
            const auto place = std::lower_bound(seen_.begin(), seen_.end(), k);
            if ((place == seen_.end() || *place != k) && meets(b, k) &&
                nearest(near_shape(k), near_[k].now.to_own(node.place)).gap < least_stride)
                seen_.insert(place, k);
        }
    }
    for (const std::size_t k : seen_)
        obstacles_[k].seen = true;
}

}  // namespace birm3d
