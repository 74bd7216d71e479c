// Memory of skin_forces, which finds it and leaves it with nothing of meaning: so that a step allocates nothing.
#pragma once

#include <cstddef>
#include <vector>

#include "birm3d/kernels/crush.hpp"
#include "birm3d/kernels/dent.hpp"
#include "birm3d/kernels/friction.hpp"
#include "birm3d/kernels/friction_tread.hpp"
#include "birm3d/scene/obstacles.hpp"

namespace birm3d {

// Sums over blocks that saw one plane, or (by general detection) one obstacle; `near`: its place in SkinMemory.
struct PlaneSums {
    std::size_t near;
    FlatContact surface;
    CrushSums sums;
};
struct ObstacleSums {
    CrushSums sums;
    Wrench by_trusses;  // of the paper's rule, in place of the projected force
    Wrench contact;     // of blocks that saw several obstacles
    double normal_force = 0.0;
    Rubbing rubbing;
    bool seen = false;  // by any block
};

// A post and a panel that it dents.
struct DentedPanel {
    std::size_t near;
    std::size_t panel;
    Dent dent, then;  // now, and an instant before
    double way;       // how far it can have come in within the step, and nodes off it (m)
};

// One of the dents that the block at hand may reach; no node is nearer to it than this (m).
struct BlockDent {
    std::size_t dent;
    double gap;
};

struct SkinMemory {
    std::vector<std::size_t> about;  // obstacles that may be near
    std::vector<NearObstacle> near;
    std::vector<Twist>
        away;  // parallel to near: the unit's motion from an obstacle that moves too, body axes
    std::vector<ObstacleSums> obstacles;  // the same
    std::vector<PlaneSums> planes;
    std::vector<DentedPanel> dents;
    std::vector<TreadContact> treads;  // that push
    // What the group of blocks at hand may see, places in near and dents; and the block at hand.
    std::vector<std::size_t> group_near, group_dents, seen;
    std::vector<BlockDent> block_dents;  // the nearest first
    std::vector<ContactLoad> contact_loads;
};

}  // namespace birm3d
