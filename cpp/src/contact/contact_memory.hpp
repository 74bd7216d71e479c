// Work buffers of find_contact_forces(). They are kept to avoid allocation; their values hold within one step only.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/crush.hpp"
#include "kernels/friction.hpp"
#include "kernels/friction_tire.hpp"
#include "kernels/indentation.hpp"
#include "scene/obstacles.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

// Sums over blocks that met one plane only. `near`: place of its obstacle in ContactMemory::near.
struct PlaneSums {
    std::size_t near;
    FlatContact surface;
    CrushSums sums;
};

// Sums over the other blocks, for one obstacle.
struct ObstacleSums {
    CrushSums sums;     // of blocks that met no other obstacle
    Wrench by_trusses;  // forces along the trusses (the paper's rule), used in place of the projected force
    Wrench contact;     // of blocks that met several obstacles
    double normal_force = 0.0;
    FrictionLoad friction_load;
    bool reached = false;  // by any block
};

// Sums over all blocks of a unit.
struct ContactSums {
    std::vector<ObstacleSums> obstacles;  // parallel to ContactMemory::near
    std::vector<PlaneSums> planes;
    std::vector<TireNodeContact> tire_nodes;  // that push on the barrier
    CrushSums several;                        // of blocks that met several obstacles

    void clear(std::size_t near) {
        obstacles.assign(near, {});
        planes.clear();
        tire_nodes.clear();
        several = {};
    }
};

// A post, or a face with a top edge, and a panel that it indents.
struct IndentedPanel {
    std::size_t near;
    std::size_t panel;
    Indentation indentation, before;  // at the end and at the start of the step
    double
        growth;  // how far the post can have moved in, and nodes can have moved off it, within the step (m)
};

// An indentation that the present block may reach. None of its nodes is nearer to it than `gap` (m).
struct BlockIndentation {
    std::size_t indentation;
    double gap;
};

struct ContactMemory {
    std::vector<std::size_t> about;      // obstacles that may be near
    std::vector<NearObstacle> near;      // in the order of the obstacles
    std::vector<Twist> relative_motion;  // parallel to near: the unit's, seen from the obstacle, body axes
    std::vector<IndentedPanel> indentations;
    ContactSums sums;
    // Indices in `near` and `indentations` of what the present group may reach, then the present block.
    std::vector<std::size_t> group_near, group_indentations, block_near;
    std::vector<BlockIndentation> block_indentations;  // the nearest first
    std::vector<ContactLoad> contact_loads;
};

}  // namespace birm3d
