#include "birm3d/contact/skin_contact.hpp"

#include <algorithm>
#include <limits>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/scene/bodies.hpp"
#include "birm3d/scene/obstacles.hpp"
#include "contact/contact_pass.hpp"
#include "contact/predicted_motion.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Obstacles that were touched an instant before are near, whatever the step has made of it.
void add_touched(const Scene& scene, std::size_t u, const State& before, const State& now,
                 std::vector<NearObstacle>& near) {
    for (const ContactLoad& touch : before.units[u].contact_loads) {
        const auto place = std::lower_bound(
            near.begin(), near.end(), touch.obstacle,
            [](const NearObstacle& known, std::size_t obstacle) { return known.index < obstacle; });
        if (place != near.end() && place->index == touch.obstacle) continue;
        near.insert(place, {touch.obstacle, placement(pose_of(scene, touch.obstacle, now), now.units[u].body),
                            placement(pose_of(scene, touch.obstacle, before), before.units[u].body)});
    }
}

}  // namespace

Skin::Skin(const Scene& scene, std::size_t u, const State& from, Trial& trial, bool far)
    : scene_(scene),
      unit_(scene.vehicle->units[u]),
      mesh_(unit_.trusses),
      before_(from.units[u]),
      now_(trial.state.units[u]),
      trial_(trial),
      u_(u),
      R_(now_.body.orientation.toRotationMatrix()),
      along_(scene.settings.contact_model == ContactModel::along_truss),
      full_speed_(scene.full_friction_speed()),
      margin_(trial.dt * (std::max(fastest_point(unit_, before_.body), fastest_point(unit_, now_.body)) +
                          std::max(fastest_segment(scene, from), fastest_segment(scene, trial.state))) +
              tolerance::touching_gap),
      near_(trial.skin.near),
      away_(trial.skin.away),
      obstacles_(trial.skin.obstacles),
      planes_(trial.skin.planes),
      dents_(trial.skin.dents),
      treads_(trial.skin.treads),
      group_near_(trial.skin.group_near),
      group_dents_(trial.skin.group_dents),
      seen_(trial.skin.seen),
      block_dents_(trial.skin.block_dents) {
    const double margin = before_.contact_loads.empty() ? 0.0 : margin_;
    find_near(scene, u, from, trial.state, far ? 2.0 * mesh_.reach : margin, trial.skin.about, near_);
    add_touched(scene, u, from, trial.state, near_);
    const bool rubs = std::any_of(near_.begin(), near_.end(), [&](const NearObstacle& obstacle) {
        return scene.obstacles[obstacle.index].friction > 0.0;
    });
    const bool treads_rub = !mesh_.tread.empty() && scene.settings.mu_tire_barrier > 0.0 && !near_.empty();
    const bool motion_matters = rubs || treads_rub || mesh_.rate_sensitivity > 0.0;
    if (motion_matters) motion_ = predicted_motion(scene, u, from, trial);
    away_.assign(near_.size(), motion_);
    if (motion_matters && !trial.state.segments.empty()) {
        const std::vector<BodyState> drifted = trial.state.segments;
        predict_segments(scene, from, trial.dt, trial.state);
        for (std::size_t k = 0; k < near_.size(); ++k) {
            const Twist other = obstacle_motion(scene, near_[k].index, trial.state, now_.body);
            away_[k].velocity -= other.velocity;
            away_[k].angular_velocity -= other.angular_velocity;
        }
        trial.state.segments = drifted;
    }
    obstacles_.assign(near_.size(), {});
    planes_.clear();
    dents_.clear();
    treads_.clear();
}

void Skin::press_blocks() {
    trial_.active[u_].clear();
    now_.dented.clear();
    if (near_.empty() && before_.contact_loads.empty() && !before_.trusses.hangs_slack()) return;
    find_dents();
    for (std::size_t g = 0; g < before_.trusses.groups.size(); ++g)
        if (look_about_group(g))
            for (std::size_t b = g * TrussMesh::group_size; b < mesh_.end_of_group(g); ++b)
                press(b);
    if (!treads_.empty()) rub_treads();
}

// Does any of the blocks push, hang slack, or come within reach of an obstacle or of a dent? Notes which of these can.
bool Skin::look_about_group(std::size_t g) {
    const BlockGroup& group = before_.trusses.groups[g];
    const std::uint8_t of = mesh_.panels_of_group[g];
    group_near_.clear();
    for (std::size_t k = 0; k < near_.size(); ++k)
        if (sees(of, k, group.box, group.touching ? margin_ : 0.0)) group_near_.push_back(k);
    group_dents_.clear();
    for (std::size_t d = 0; d < dents_.size(); ++d)
        if (reach_of_dent(dents_[d], of, group.box, group.touching) < infinity) group_dents_.push_back(d);
    return group.touching || group.slack || !group_near_.empty() || !group_dents_.empty();
}

// Can nodes of some panels, bit by bit, within a box meet the obstacle itself?
bool Skin::sees(std::uint8_t of, std::size_t near, const Box& box, double margin) const {
    return !is_left_to_dents(of, near) &&
           within_reach(scene_.obstacles[near_[near].index].shape, near_[near].now, box, margin);
}

// Nodes that an obstacle has drawn out beyond the free length of their trusses return to it once their way is free.
void Skin::spring_back(std::size_t b) {
    sprung_back_ = false;
    const TrussBlockState& block = before_.trusses.block[b];
    if (!block.slack) return;
    const TrussBlock& truss = mesh_.block[b];
    sprung_ = block;
    sprung_.slack = false;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!is_slack(block, i)) continue;
        const Vec3 anchor(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
        const Vec3 place = anchor - (truss.length[i] - block.residual[i]) *
                                        (anchor - Vec3(block.x[i], block.y[i], block.z[i])).normalized();
        bool free = true;
        for (std::size_t k = 0; k < near_.size() && free; ++k)
            free = !meets(b, k) ||
                   nearest(scene_.obstacles[near_[k].index].shape, near_[k].now.to_own(place)).gap >= 0.0;
        if (!free) {
            sprung_.slack = true;
            continue;
        }
        sprung_.x[i] = place.x(), sprung_.y[i] = place.y(), sprung_.z[i] = place.z();
        sprung_.deflection[i] = block.residual[i];
        sprung_back_ = true;
    }
    if (sprung_back_) sprung_.box = box_around(sprung_.x, sprung_.y, sprung_.z);
}

// Which obstacles can the nodes of the block meet?
void Skin::look_about(std::size_t b) {
    spring_back(b);
    const bool touching = from(b).touching;
    // Where there is one obstacle, nodes that push do so on it.
    if (touching && near_.size() == 1 && meets(b, 0))
        seen_.assign(1, 0);
    else
        find_seen(b, touching ? margin_ : 0.0);
}

namespace {

BIRM3D_LANE_LOOP double lowest(const Lanes& values) {
    alignas(64) Lanes turned;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        turned[i] = -values[i];
    return -lane_max(turned);
}

}  // namespace

void Skin::press(std::size_t b) {
    look_about(b);
    const bool drawn = find_dents_of_block(b);
    // What pushes stays at what it pushes on until it is released, however far it was drawn off within the step.
    if (from(b).touching && seen_.empty())
        for (std::size_t k = 0; k < near_.size(); ++k)
            if (meets(b, k)) seen_.push_back(k);
    if (seen_.empty() && !sprung_back_) return;
    trial_.state.statistics.node_evaluations += lanes;
    for (const std::size_t k : seen_)
        obstacles_[k].seen = true;
    PlaneSums* const plane = seen_.size() == 1 && !drawn ? plane_of(seen_[0], b) : nullptr;
    if (plane == nullptr && !seen_.empty()) {
        look(b);
        const bool idle = !from(b).touching && !from(b).slack && !sprung_back_;
        if (idle && lowest(faces_.gap) >= 0.0) return;
    }
    trial_.active[u_].add(b);
    trial_.stale[u_].add(b);
    note_met(b);
    TrussBlockState& next = now_.trusses.block[b];
    if (seen_.empty()) {
        next = sprung_;
    } else if (plane != nullptr) {
        press_plane(*plane, b);
    } else {
        press_shapes(b);
    }
    next.met = true;
    next.box = box_around(next.x, next.y, next.z);
}

// For the statistics.
void Skin::note_met(std::size_t b) {
    if (before_.trusses.block[b].met) return;
    StepStatistics& statistics = trial_.state.statistics;
    (b < mesh_.shell_blocks ? statistics.skin_nodes : statistics.tread_nodes) += mesh_.nodes_in(b);
}

// The plane that is all that the block at hand can meet of an obstacle; null if it can meet more.
PlaneSums* Skin::plane_of(std::size_t near, std::size_t b) {
    const Shape& shape = scene_.obstacles[near_[near].index].shape;
    if (std::holds_alternative<HalfSpace>(shape) && !planes_.empty() && planes_.back().near == near)
        return &planes_.back();  // the same plane to all blocks
    const auto plane = flat_part(shape, near_[near].now, from(b).box);
    return plane ? &sums_of_plane(near, *plane) : nullptr;
}

void Skin::find_seen(std::size_t b, double margin) {
    seen_.clear();
    for (const std::size_t k : group_near_)
        if (meets(b, k) && sees(mesh_.panels_of[b], k, from(b).box, margin)) seen_.push_back(k);
}

PlaneSums& Skin::sums_of_plane(std::size_t near, const HalfSpace& plane) {
    for (PlaneSums& known : planes_)
        if (known.near == near && known.surface.face.normal == plane.normal) return known;
    const NearObstacle& obstacle = near_[near];
    HalfSpace before = plane;
    before.normal = obstacle.before.rotation.transpose() * (obstacle.now.rotation * plane.normal);
    planes_.push_back({near, FlatContact(unit_.body, plane, before), {}});
    return planes_.back();
}

// The rate of deflection is taken where the nodes will be, so that a rate-sensitive block is first crushed without it.
template <class Crush>
void Skin::crush_with_rate(std::size_t near, const TrussBlockState& next, const Places& places,
                           CrushSums& sums, const Crush& crush) {
    if (mesh_.rate_sensitivity == 0.0) {
        crush(nullptr, sums);
        return;
    }
    CrushSums without;
    crush(nullptr, without);
    alignas(64) Lanes factor;
    find_rate_factor(near, next, places, factor);
    crush(&factor, sums);
}

void Skin::find_rate_factor(std::size_t near, const TrussBlockState& next, const Places& places,
                            Lanes& factor) const {
    const auto set = [&](const Twist& away, Lanes& to) {
        set_rate_factor(mesh_.rate_sensitivity, next.force, away, places, contact_, to);
    };
    if (near != several) return set(away_[near], factor);
    if (trial_.state.segments.empty()) return set(motion_, factor);
    alignas(64) Lanes own;
    for (std::size_t k = 0; k < seen_.size(); ++k) {
        set(away_[seen_[k]], own);
        for (std::size_t i = 0; i < lanes; ++i)
            if (nearest_[i] == k) factor[i] = own[i];
    }
}

void Skin::press_plane(PlaneSums& plane, std::size_t b) {
    const TrussBlockState& next = now_.trusses.block[b];
    if (!plane_normal_ || *plane_normal_ != plane.surface.face.normal)
        contact_.set_normal(plane_normal_.emplace(plane.surface.face.normal));
    const bool ceased = crush_plane(plane, b, plane.sums);
    if ((ceased || springs_off(b)) && find_stopped(b, &plane.surface)) {
        CrushSums undone;
        crush_plane(plane, b, undone);
        plane.sums -= undone;
        return press_again(b);
    }
    if (next.touching) rub(plane.near, b, next, {next.x, next.y, next.z}, contact_);
}

// Returns whether any node ceased to push.
bool Skin::crush_plane(const PlaneSums& plane, std::size_t b, CrushSums& to) {
    TrussBlockState& next = now_.trusses.block[b];
    bool ceased = false;
    crush_with_rate(plane.near, next, {next.x, next.y, next.z}, to,
                    [&](const Lanes* factor, CrushSums& sums) {
                        ceased = crush(plane.surface, mesh_, b, factor, from(b), next, contact_, sums);
                    });
    return ceased;
}

// The one obstacle that all nodes of the block push on which push, or are inside of; or `several`.
std::size_t Skin::where_met(const Lanes& force) const {
    if (seen_.size() == 1) return seen_[0];
    std::optional<std::size_t> only;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(force[i] > 0.0 || faces_.gap[i] < 0.0)) continue;
        if (only && *only != nearest_[i]) return several;
        only = nearest_[i];
    }
    return seen_[only.value_or(0)];
}

void Skin::press_shapes(std::size_t b) {
    const bool may_go_into_another = std::any_of(seen_.begin(), seen_.end(), [&](std::size_t k) {
        return std::holds_alternative<Prism>(scene_.obstacles[near_[k].index].shape);
    });
    // A node that does may find itself at another obstacle, too.
    const bool fixed = corners_.empty() && (seen_.size() == 1 || !may_go_into_another);
    const std::size_t at = fixed ? where_met(from(b).force) : several;
    CrushSums& to = at != several ? obstacles_[at].sums : shared_;
    const bool ceased = crush_shapes(b, at, to);
    if ((ceased || springs_off(b)) && find_stopped(b, nullptr)) {
        CrushSums undone;
        crush_shapes(b, at, undone);
        to -= undone;
        return press_again(b);
    }
    rub_shapes(at, b);
}

// Returns whether any node ceased to push. `at`: the obstacle that they all meet, or `several`.
bool Skin::crush_shapes(std::size_t b, std::size_t at, CrushSums& to) {
    TrussBlockState& next = now_.trusses.block[b];
    bool ceased = false;
    crush_with_rate(at, next, contact_.places(), to, [&](const Lanes* factor, CrushSums& sums) {
        ceased = crush(faces_, unit_.body, mesh_, b, factor, from(b), next, contact_, sums);
    });
    return ceased;
}

// Once nodes that were let go have been stopped by other surfaces.
void Skin::press_again(std::size_t b) {
    stop(b);
    look(b);
    crush_shapes(b, several, shared_);
    rub_shapes(several, b);
}

void Skin::rub_shapes(std::size_t at, std::size_t b) {
    const TrussBlockState& next = now_.trusses.block[b];
    if (!next.touching) return;
    if (at != several)
        rub(at, b, next, contact_.places(), contact_);
    else
        share_out(b, next);
}

void skin_forces(const Scene& scene, std::size_t u, const State& from, Trial& trial) {
    Skin skin(scene, u, from, trial);
    skin.press_blocks();
    if (!skin.overlooks()) return skin.hand_over();
    Skin further(scene, u, from, trial, true);
    further.press_blocks();
    further.hand_over();
}

}  // namespace birm3d
