// One pass over the blocks of a unit at one instant, in body axes: its constant parameters and what it changes.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contact/contact_memory.hpp"
#include "contact/corner.hpp"
#include "kernels/detect.hpp"
#include "scene/obstacles.hpp"
#include "state/block_contact.hpp"

namespace birm3d {

// Stands for several obstacles in place of an index.
inline constexpr std::size_t several_obstacles = static_cast<std::size_t>(-1);

// Constant parameters of a pass.
struct ContactPass {
    const Scene& scene;
    const std::size_t unit_index;
    const Unit& unit;
    const TrussMesh& mesh;
    const UnitState& before;           // the unit at the start of the step
    const State& now;                  // all bodies have drifted
    const bool along_trusses;          // the paper's rule for the direction of forces
    const double full_friction_speed;  // see kernels/friction.hpp (m/s)
    const double margin;               // how far a held node can have left its surface within the step (m)
    Twist motion = {};  // of the unit at the end of the step, where friction or a rate asks for it
    std::span<const NearObstacle> near = {};      // what the unit can touch
    std::span<const Twist> relative_motion = {};  // parallel to near: the unit's, seen from the obstacle
    std::span<const IndentedPanel> indentations = {};
    std::uint8_t indented_before = 0;  // panels that posts had indented before the step, bit by bit
    std::uint8_t left_panels = 0;      // the same, of panels that a post has ceased to indent since
    double greatest_following =
        0.0;  // bound of how far a node follows an indentation outwards within the step (m)

    const Obstacle& obstacle(std::size_t k) const { return scene.obstacles[near[k].index]; }
    const Shape& shape(std::size_t k) const { return obstacle(k).shape; }
    // Do nodes of an indented panel follow the indentation instead of the surface of what makes it? They do at a post.
    bool replaces_surface(const IndentedPanel& indented) const { return !obstacle(indented.near).top_edge; }
    // Tire nodes meet the barrier only: the wheels stand on the ground as rigid contacts.
    bool meets(std::size_t block, std::size_t k) const {
        return block < mesh.shell_blocks || near[k].index != scene.ground;
    }
};

// A face that a node met within the step, as a plane in body axes.
struct MetFace {
    std::size_t near = 0;        // index in ContactPass::near of its obstacle
    Vec3 normal = Vec3::Zero();  // outward; zero: no face
    double gap = 0.0;            // of the node's place at the start of the step (m)
};

// A released node that another surface stopped on its way.
struct StoppedNode {
    std::size_t node_index;
    Vec3 place;
    double deflection, residual, peak_deflection, force;  // of its truss there
    double unloading;                                     // see TrussBlockState
    double work;                                          // on its truss up to the release (J)
    MetFace released_by = {}, stopped_by = {};            // not set where an indentation has vanished
    bool stays = false;  // has the node been on `stopped_by` since the start of the step?
};

// The block of nodes that is being computed. One object serves all blocks; begin() resets it.
struct ContactBlock {
    explicit ContactBlock(ContactMemory& memory)
        : reachable(memory.block_near), indentations(memory.block_indentations) {}

    void begin(std::size_t block, const TrussBlockState& at_start, TrussBlockState& at_end) {
        index = block;
        start = &at_start;
        end = &at_end;
        hangs = false;
        lagging.reset();
    }
    // The start of the step in a copy, where nodes can be placed elsewhere.
    TrussBlockState& alter() {
        if (!is_altered()) altered = *start;
        start = &altered;
        return altered;
    }
    bool is_altered() const { return start == &altered; }
    // `before`: at the start of the step.
    void set_normals(std::size_t i, const Vec3& now, const Vec3& before) {
        contact.nx[i] = now.x(), contact.ny[i] = now.y(), contact.nz[i] = now.z();
        faces.bx[i] = before.x(), faces.by[i] = before.y(), faces.bz[i] = before.z();
    }

    std::size_t index = 0;
    const TrussBlockState* start = nullptr;  // as the step finds the block, or `altered`
    TrussBlockState* end = nullptr;          // as the step leaves it
    TrussBlockState altered;
    std::vector<std::size_t>&
        reachable;  // indices in ContactPass::near of the obstacles that the block can reach
    std::vector<BlockIndentation>& indentations;  // that it can reach

    NodeFaces faces;
    BlockContact contact;
    std::array<std::size_t, block_size> nearest;  // index in `reachable` of each node's obstacle
    alignas(64) BlockColumn second_gap;  // of each node, to the second nearest of several obstacles (m)
    alignas(64) BlockColumn released;    // nodes that an indentation releases (1, else 0)
    bool hangs;                          // does any of its nodes follow a top edge, or lag?
    std::bitset<block_size> lags;        // nodes that lag inside their nearest surface, see lagging_nodes.hpp
    std::bitset<block_size> lagging;     // at the end of the step, see TrussBlockState
    std::optional<Vec3> flat_normal;     // of all nodes in `contact`, where they met one plane
    std::vector<Corner> corners;         // nodes that are on several surfaces
    std::vector<StoppedNode> stopped;
};

// Obstacles that only a released node can reach. They are searched when a node is released.
struct DistantObstacles {
    std::vector<NearObstacle> list;
    bool are_found = false;
    bool were_met =
        false;  // has a node reached one? Then the pass is repeated with these among the near obstacles.
};

// Everything that a pass changes.
struct ContactState {
    explicit ContactState(ContactMemory& memory) : sums(memory.sums), block(memory) {}

    ContactSums& sums;
    ContactBlock block;
    DistantObstacles distant;
};

}  // namespace birm3d
