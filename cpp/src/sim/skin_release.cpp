// Nodes that a surface lets go. The truss of such a node drives it off the surface, outwards along itself, until it has
// its residual length or another surface stops it. On that way nothing outside does work: what the truss loses is lost.
#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/sim/obstacles.hpp"
#include "sim/skin.hpp"

namespace birm3d {

namespace {

// Of two points on the way this far apart, a surface between them is seen (m).
constexpr double least_stride = 2e-3;

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

// Where the first surface on the way of a node stops it; none where the way is free.
std::optional<Vec3> Skin::stop_on_way(std::size_t b, std::size_t i, const Vec3& start,
                                      const Vec3& end) const {
    const Vec3 way = end - start;
    const double length = way.norm();
    const auto gap_at = [&](double share, double enough) {
        const Vec3 place = start + share * way;
        double least = enough;
        for (std::size_t k = 0; k < near_.size(); ++k)
            if (is_solid_to(b, i, k))
                least = std::min(least, nearest(scene_.obstacles[near_[k].index].shape,
                                                near_[k].now.to_own(place))
                                            .gap);
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

// Nodes that `plane`, or where it is null the faces at hand, let go, and that other surfaces stop on their way: the block
// is altered so that they stand there. Returns the work done on their trusses up to the release (J); none where no node
// was stopped.
std::optional<double> Skin::stop_released(std::size_t b, const FlatContact* plane) {
    const TrussBlock& truss = mesh_.block[b];
    const TrussBlockState& next = now_.trusses.block[b];
    std::optional<double> work;
    for (std::size_t i = 0; i < lanes; ++i) {
        const double force = from(b).force[i];
        if (!(force > 0.0 && next.force[i] == 0.0)) continue;
        const Vec3 anchor(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
        const Vec3 to(next.x[i], next.y[i], next.z[i]), was(from(b).x[i], from(b).y[i], from(b).z[i]);
        // The face held it to the end of the step, but where it moved off by itself: see release() in crush_rows.cpp.
        const Vec3 held = plane != nullptr ? Vec3(was - (plane->face.normal.dot(was) - plane->face.offset) *
                                                            plane->holding)
                                           : Vec3(contact_.px[i], contact_.py[i], contact_.pz[i]);
        const Vec3 n = plane != nullptr ? plane->face.normal : contact_.normal(i);
        if ((anchor - held).dot(n) > 0.0 || (to - held).norm() <= tolerance::touching_gap) continue;
        const auto stop = stop_on_way(b, i, held, to);
        if (!stop) continue;
        const double residual = next.residual[i];
        const double let_go = truss.length[i] - (held - anchor).norm();
        const double deflection = truss.length[i] - (*stop - anchor).norm();
        TrussBlockState& block = altered(b);
        work = work.value_or(0.0) + 0.5 * force * (let_go - block.deflection[i]);
        block.x[i] = stop->x(), block.y[i] = stop->y(), block.z[i] = stop->z();
        block.deflection[i] = deflection;
        block.residual[i] = residual;
        block.peak_deflection[i] = next.peak_deflection[i];
        block.force[i] = std::max(0.0, truss.k_unloading[i] * (deflection - residual));
        for (std::size_t k = 0; k < near_.size(); ++k)
            if (meets(b, k) && std::find(seen_.begin(), seen_.end(), k) == seen_.end() &&
                nearest(scene_.obstacles[near_[k].index].shape, near_[k].now.to_own(*stop)).gap <
                    least_stride)
                seen_.insert(std::lower_bound(seen_.begin(), seen_.end(), k), k);
    }
    if (work) altered(b).touching = true;
    return work;
}

}  // namespace birm3d
