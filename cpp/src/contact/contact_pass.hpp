// What skin_forces and its dents share: one unit's skin within one step.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "birm3d/contact/trial.hpp"
#include "birm3d/kernels/detect.hpp"
#include "contact/corner.hpp"

namespace birm3d {

// A node that was let go and stopped on its way.
struct Stopped {
    std::size_t lane;
    Vec3 place;
    double deflection, residual, peak_deflection, force;  // of its truss there
    double work;                                          // on it, up to the release (J)
};

// One unit's skin within one step; body axes.
class Skin {
  public:
    Skin(const Scene& scene, std::size_t u, const State& from, Trial& trial, bool far = false);

    void press_blocks();
    // Has a node sprung to an obstacle that was not taken for near? Then all is to be found anew, by a skin that looks
    // `far`.
    bool overlooks() const { return overlooks_; }

    void hand_over();  // sums and touches, to the trial

  private:
    static constexpr std::size_t several = static_cast<std::size_t>(-1);
    static constexpr double infinite = std::numeric_limits<double>::infinity();

    bool look_about_group(std::size_t g);
    void press(std::size_t b);
    void note_met(std::size_t b);
    void look_about(std::size_t b);
    void spring_back(std::size_t b);
    const TrussBlockState& from(std::size_t b) const {
        return sprung_back_ ? sprung_ : before_.trusses.block[b];
    }
    const Shape& near_shape(std::size_t near) const { return scene_.obstacles[near_[near].index].shape; }
    void find_dents();
    Dented dents_of(std::size_t near);
    bool was_before(std::size_t near, std::size_t panel);
    double reach_of_dent(const DentedPanel& dented, std::uint8_t of, const Box& box, bool touching) const;
    bool find_dents_of_block(std::size_t b);
    bool is_left_to_dents(std::uint8_t of, std::size_t near) const;
    void leave_to_dents(std::size_t b, std::size_t near, NearestLanes& found) const;
    void draw_in(std::size_t b, const TrussBlockState& block);
    // Does the block meet what is near? Treads meet the barrier only: the wheels stand on the ground.
    bool meets(std::size_t b, std::size_t near) const {
        return b < mesh_.shell_blocks || near_[near].index != scene_.ground;
    }
    void find_seen(std::size_t b, double margin);
    bool sees(std::uint8_t of, std::size_t near, const Box& box, double margin) const;
    PlaneSums* plane_of(std::size_t near, std::size_t b);
    PlaneSums& sums_of_plane(std::size_t near, const HalfSpace& plane);
    void press_plane(PlaneSums& plane, std::size_t b);
    void press_shapes(std::size_t b);
    void press_again(std::size_t b);
    bool crush_plane(const PlaneSums& plane, std::size_t b, CrushSums& sums);
    bool crush_shapes(std::size_t b, std::size_t at, CrushSums& sums);
    void rub_shapes(std::size_t at, std::size_t b);
    std::size_t where_met(const Lanes& force) const;
    TrussBlockState& altered(std::size_t b);
    bool find_stopped(std::size_t b, const FlatContact* plane);
    bool springs_off(std::size_t b) const;
    bool springs_off(std::size_t b, std::size_t i) const;
    void stop(std::size_t b);
    void look_further();
    std::optional<Vec3> stop_on_way(std::size_t b, std::size_t i, const Vec3& start, const Vec3& end) const;
    bool is_solid_to(std::size_t b, std::size_t i, std::size_t near) const;
    void look(std::size_t b);
    bool look_at_surfaces(std::size_t b, const TrussBlockState& block);
    void look_at(std::size_t b, const TrussBlockState& block);
    bool stay_on_planes(const TrussBlockState& block) const;
    void turn_flat_faces();
    void settle_in_corners(std::size_t b);
    void settle(std::size_t b, std::size_t i);
    CornerFace own_face(std::size_t i) const;
    CornerFace face_at(std::size_t k, const Vec3& place, const Vec3& node) const;
    bool stood_on(std::size_t k, const Vec3& normal, const Vec3& node) const;
    bool was_on(const CornerFace& face, const Vec3& node) const;
    void add_pushed(std::size_t b, const Vec3& node, const CornerFace& own, bool stays, Corner& corner) const;
    void add_driving(std::size_t b, const Vec3& node, Corner& corner) const;
    void place(std::size_t b, const Corner& corner, const Vec3& to);
    void share_out_corners(std::size_t b, const TrussBlockState& next);
    bool find_entered_faces(const TrussBlockState& block);
    void share_out(std::size_t b, const TrussBlockState& next);
    void rub(std::size_t near, std::size_t b, const TrussBlockState& next, const Places& places,
             const BlockContact& contact);
    void note_treads(std::size_t near, std::size_t b, const Places& places, const BlockContact& contact);
    void rub_treads();
    // `near`: place in near_ of the obstacle that the block sees, or `several`.
    template <class Crush>
    void crush_with_rate(std::size_t near, const TrussBlockState& next, const Places& places, CrushSums& sums,
                         const Crush& crush);
    void find_rate_factor(std::size_t near, const TrussBlockState& next, const Places& places,
                          Lanes& factor) const;

    const Scene& scene_;
    const Unit& unit_;
    const TrussMesh& mesh_;
    const UnitState& before_;
    UnitState& now_;
    Trial& trial_;
    const std::size_t u_;
    const Mat3 R_;
    const bool along_;
    const double full_speed_;  // see kernels/friction.hpp (m/s)
    double margin_;            // how far a held node can have come off its surface within the step (m)
    Twist motion_;             // body axes; only friction and the rate of deflection ask for it
    CrushSums shared_;         // of blocks that saw several obstacles

    // See SkinMemory.
    std::vector<NearObstacle>& near_;
    std::vector<Twist>& away_;
    std::vector<ObstacleSums>& obstacles_;
    std::vector<PlaneSums>& planes_;
    std::vector<DentedPanel>& dents_;
    std::vector<TreadContact>& treads_;
    std::vector<std::size_t>&group_near_, &group_dents_, &seen_;
    std::vector<BlockDent>& block_dents_;

    TrussBlockState sprung_;  // the block at hand, if some of its nodes have sprung back or stand in corners
    bool sprung_back_ = false;
    std::vector<Corner> corners_;  // of the block at hand
    std::vector<NearObstacle> further_;
    bool looked_further_ = false, overlooks_ = false;
    std::vector<Stopped> stopped_;  // the same
    std::uint8_t dented_ = 0;       // panels that posts dented before the step, bit by bit
    double furthest_ = infinite;    // that a node of these can follow its dent outwards within the step (m)
    alignas(64) Lanes second_gap_;  // of each node, to the second nearest of several obstacles (m)
    alignas(64) Lanes let_go_;      // nodes that a dent lets go (1, else 0)
    NodeFaces faces_;
    BlockContact contact_;
    std::optional<Vec3> plane_normal_;        // of all nodes in contact_, where they saw one plane
    std::array<std::size_t, lanes> nearest_;  // place in seen_ of each node's obstacle
};

}  // namespace birm3d
