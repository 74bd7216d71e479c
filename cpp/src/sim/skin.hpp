// What skin_forces and its dents share: one unit's skin within one step.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "birm3d/kernels/crush.hpp"
#include "birm3d/kernels/dent.hpp"
#include "birm3d/kernels/detect.hpp"
#include "birm3d/sim/trial.hpp"

namespace birm3d {

// From a node to its anchor, unit.
inline Vec3 inward(const TrussBlock& truss, const TrussBlockState& now, std::size_t i) {
    return Vec3(truss.anchor_x[i] - now.x[i], truss.anchor_y[i] - now.y[i], truss.anchor_z[i] - now.z[i])
        .normalized();
}

// One unit's skin within one step; body axes.
class Skin {
  public:
    Skin(const Scene& scene, std::size_t u, const State& from, Trial& trial);

    void press_blocks();
    void find_dents();
    void hand_over();  // sums and touches, to the trial

  private:
    // Sums over blocks that saw one plane, or (by general detection) one obstacle.
    struct PlaneSums {
        std::size_t near;
        FlatContact surface;
        CrushSums sums;
    };
    struct ObstacleSums {
        CrushSums sums;
        Wrench by_trusses;  // of the paper's rule, in the stead of the projected force
        Wrench contact;     // of blocks that saw several obstacles
        double normal_force = 0.0;
        SkinForces friction;
    };

    void press(std::size_t b);
    bool look_about(std::size_t b);
    void spring_back(std::size_t b);
    const TrussBlockState& from(std::size_t b) const {
        return sprung_back_ ? sprung_ : before_.trusses.block[b];
    }
    void draft(std::size_t b);
    bool draw_in(std::size_t b);
    void find_seen(const Box& box, double margin);
    PlaneSums& sums_of_plane(std::size_t near, const HalfSpace& plane);
    void press_plane(PlaneSums& plane, std::size_t b);
    void press_shapes(std::size_t b);
    void crush_shapes(std::size_t b, const TrussBlockState& block, TrussBlockState& next, CrushSums& to);
    const TrussBlockState& look(std::size_t b);
    void turn_flat_faces();
    void find_places_on_lines(std::size_t b, const TrussBlockState& block);
    void settle_in_corners(const TrussBlockState& block);
    void find_entered_faces(const TrussBlockState& block);
    const TrussBlockState& follow_with_leading(std::size_t b);
    bool set_hanging(std::size_t b);
    void note_drawn(TrussBlockState& next);
    void load_drivers();
    bool leads(std::size_t b, std::size_t lane) const {
        return (before_.trusses.block[b].leading >> lane & 1U) != 0;
    }
    void share_out(std::size_t b, const TrussBlockState& next);
    void rub(std::size_t near, std::size_t b, const TrussBlockState& next, const BlockContact& contact);
    template <class Crush>
    void crush_with_rate(const TrussBlockState& next, CrushSums& sums, const Crush& crush);

    const Scene& scene_;
    const Unit& unit_;
    const TrussMesh& mesh_;
    const UnitState& before_;
    UnitState& now_;
    Trial& trial_;
    const std::size_t u_;
    const Mat3 R_;
    const bool along_;
    double full_speed_;
    double
        held_;  // see in_line; a dent leaves its obstacle where that grows steeper, so that nothing need fade
    double margin_;  // how far a held node can have come off its surface within the step (m)
    Twist motion_;   // body axes; only friction and the rate of deflection ask for it

    std::vector<NearObstacle>& near_;
    std::vector<std::size_t> seen_;  // by the block at hand, places in near_
    std::vector<PlaneSums> planes_;
    std::vector<ObstacleSums> obstacles_;  // parallel to near_
    CrushSums shared_;                     // of blocks that saw several obstacles
    // Nodes pressed by obstacles that hold the skin, on which others may hang, with what these add to their pressure.
    struct Driver {
        std::size_t near, block, lane;
        Vec3 normal;       // of the obstacle
        double per_force;  // normal force for each unit of truss force
        double extra = 0.0;
    };
    std::vector<Driver> drivers_;
    std::vector<std::size_t> drafted_;  // blocks
    TrussBlockState sprung_;            // the block at hand, if some of its nodes have sprung back
    bool sprung_back_ = false;
    TrussBlockState followed_;
    std::vector<DentDriver> dent_;  // parallel to drivers_
    std::vector<DentGroup> dent_groups_;
    Box dent_box_;  // around all that can hang on them
    Hanging hanging_;
    Box box_;  // around the nodes of the block at hand
    NodeFaces faces_;
    BlockContact contact_;
    // Place in seen_ of each node's obstacle; by_dent for nodes that hang on others.
    std::array<std::size_t, lanes> nearest_;
    static constexpr std::size_t by_dent = lanes;
};

}  // namespace birm3d
