// What a crash changes in a unit's skin: blocks parallel to TrussMesh's.
#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <numeric>
#include <vector>

#include "birm3d/base/hash.hpp"
#include "birm3d/base/tolerances.hpp"
#include "birm3d/model/recovery.hpp"
#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

// What a block of trusses has met. All are false of an uncrushed block.
struct BlockFlags {
    bool touching = false;  // does any node push on an obstacle?
    bool slack = false;     // does an obstacle hold any node beyond the free length of its truss?
    bool met = false;       // has anything come into it, in any step?
    // Does any node follow a top edge (top_edge.hpp), or lag inside a surface since then? It may sink below the edge.
    bool hangs = false;
    // Nodes that the upright edge of a wall has carried along, past its axis and into the wall's face. They lag inside it.
    std::bitset<block_size> lagging;

    bool may_lag() const { return hangs || lagging.any(); }
    bool may_lag(std::size_t i) const { return hangs || lagging[i]; }
};

struct alignas(64) TrussBlockState : BlockFlags {
    BlockColumn x, y, z;                    // shell nodes in body axes (m)
    BlockColumn deflection, force;          // of the truss, now (m, N)
    BlockColumn peak_deflection, residual;  // greatest so far; where unloading meets zero force (m)
    BlockColumn unloading;                  // coefficient of unloading, see unloading_force() (N/m or N/m^n)
    Box box;                                // around the nodes, body axes
};

// Force of a truss below its envelope (truss_law.hpp): along a line, or with a recovery along the curve (N).
// By squares, as in the kernel, the power would round otherwise; in turn it keeps the bits of earlier runs.
inline double unloading_force(const TrussBlock& truss, const TrussBlockState& state, std::size_t i,
                              double deflection) {
    const double u = std::max(0.0, deflection - state.residual[i]);
    return state.unloading[i] * (has_recovery(truss.recovery[i]) ? power_in_turn<recovery_degree>(u)
                                                                 : power_in_turn<line_degree>(u));
}

// Does an obstacle hold the node beyond the free length of its truss? A truss does not pull.
inline bool is_slack(const TrussBlockState& block, std::size_t i) {
    return block.force[i] == 0.0 && block.residual[i] - block.deflection[i] > tolerance::touching_gap;
}

// A group of blocks (see TrussMesh).
struct BlockGroup {
    Box box;                // around the boxes of its blocks
    bool touching = false;  // any of them?
    bool slack = false;     // the same
    bool hangs = false;     // the same

    // `first`: of the group.
    void add(const TrussBlockState& block, bool first) {
        box = first ? block.box : box.with(block.box);
        touching |= block.touching;
        slack |= block.slack;
        hangs |= block.hangs;
    }
};

struct TrussState {
    explicit TrussState(const TrussMesh& mesh)
        : block(mesh.blocks), groups(mesh.panels_of_group.size()), recovers_(mesh.recovers) {
        for (std::size_t b = 0; b < block.size(); ++b)
            uncrush(mesh, b);
        std::vector<std::size_t> all(block.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        group(mesh, all);
    }

    // Back to the uncrushed skin.
    void reset(const TrussMesh& mesh) {
        const std::vector<std::size_t> changed = met();
        for (const std::size_t b : changed)
            uncrush(mesh, b);
        group(mesh, changed);
    }

    // Into which blocks has anything come? All others are as they were made.
    std::vector<std::size_t> met() const {
        std::vector<std::size_t> blocks;
        for (std::size_t b = 0; b < block.size(); ++b)
            if (block[b].met) blocks.push_back(b);
        return blocks;
    }

    // After some blocks, in their order, have changed.
    void group(const TrussMesh& mesh, const std::vector<std::size_t>& changed) {
        std::size_t last = groups.size();
        for (const std::size_t b : changed)
            if (b / TrussMesh::group_size != last) group(mesh, last = b / TrussMesh::group_size);
        around = mesh.anchors;
        for (const BlockGroup& group_of_blocks : groups)
            around = around.with(group_of_blocks.box);
    }

    // Does an obstacle hold any node beyond the free length of its truss? Such a node may return by itself.
    bool has_slack() const {
        return std::any_of(groups.begin(), groups.end(), [](const BlockGroup& group) { return group.slack; });
    }

    std::vector<TrussBlockState> block;
    std::vector<BlockGroup> groups;  // of these blocks, in their order
    Box around;                      // all nodes, however they were drawn out, and the anchors; body axes

    // Eight interleaved hashes: a processor computes them at the same time.
    void add_to(Hash& hash) const {
        constexpr std::size_t streams = 8;
        static_assert(block_size % streams == 0);
        std::array<Hash, streams> parts;
        const auto add_column = [&parts](const BlockColumn& column) {
            for (std::size_t i = 0; i < block_size; i += streams)
                for (std::size_t stream = 0; stream < streams; ++stream)
                    parts[stream].add(column[i + stream]);
        };
        for (const TrussBlockState& b : block) {
            for (const BlockColumn* column :
                 {&b.x, &b.y, &b.z, &b.deflection, &b.force, &b.peak_deflection, &b.residual})
                add_column(*column);
            if (recovers_) add_column(b.unloading);
        }
        for (const Hash& part : parts)
            hash.add(part.value());
    }

  private:
    void uncrush(const TrussMesh& mesh, std::size_t b) {
        const TrussBlock& truss = mesh.block[b];
        TrussBlockState& state = block[b];
        state.x = truss.node_x, state.y = truss.node_y, state.z = truss.node_z;
        for (BlockColumn* column : {&state.deflection, &state.force, &state.peak_deflection, &state.residual})
            column->fill(0.0);
        state.unloading = truss.k_unloading;
        static_cast<BlockFlags&>(state) = {};
        // The curve of a truss that was never loaded is above its envelope.
        if (mesh.recovers)
            for (std::size_t i = 0; i < block_size; ++i)
                if (has_recovery(truss.recovery[i])) state.unloading[i] = uncrushed_coefficient;
        state.box = mesh.node_box[b];
    }
    void group(const TrussMesh& mesh, std::size_t g) {
        groups[g] = {};
        const std::size_t first = g * TrussMesh::group_size;
        for (std::size_t b = first; b < mesh.end_of_group(g); ++b)
            groups[g].add(block[b], b == first);
    }

    bool recovers_;  // see TrussMesh
};

}  // namespace birm3d
