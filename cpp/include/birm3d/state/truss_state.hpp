// What a crash changes in a unit's skin: blocks parallel to TrussMesh's.
#pragma once

#include <array>
#include <vector>

#include "birm3d/base/hash.hpp"
#include "birm3d/base/tolerances.hpp"
#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

struct alignas(64) TrussBlockState {
    Lanes x, y, z;                    // shell nodes in body axes (m)
    Lanes deflection, force;          // of the truss, now (m, N)
    Lanes peak_deflection, residual;  // greatest so far; where the unloading line meets zero force (m)
    Box box;                          // around the nodes where they were last let go, body axes
    bool touching;                    // does any node push on an obstacle?
    bool slack;  // has an obstacle drawn any node out beyond the free length of its truss?
    bool met;    // has anything come into it, in any step? Statistics only
};

// Was the node drawn out beyond the free length of its truss? A truss does not pull.
inline bool is_slack(const TrussBlockState& block, std::size_t i) {
    return block.force[i] == 0.0 && block.residual[i] - block.deflection[i] > tolerance::touching_gap;
}

struct TrussState {
    explicit TrussState(const TrussMesh& mesh) : block(mesh.blocks) { reset(mesh); }

    // Back to the uncrushed skin.
    void reset(const TrussMesh& mesh) {
        for (std::size_t b = 0; b < mesh.blocks; ++b) {
            block[b] = {};
            block[b].x = mesh.block[b].node_x;
            block[b].y = mesh.block[b].node_y;
            block[b].z = mesh.block[b].node_z;
            block[b].box = mesh.node_box[b];
        }
    }

    std::vector<TrussBlockState> block;

    // Eight hashes in turn: each number waits for the one before it in its own hash only.
    void add_to(Hash& hash) const {
        constexpr std::size_t turns = 8;
        static_assert(lanes % turns == 0);
        std::array<Hash, turns> parts;
        for (const TrussBlockState& b : block)
            for (const Lanes* column :
                 {&b.x, &b.y, &b.z, &b.deflection, &b.force, &b.peak_deflection, &b.residual})
                for (std::size_t i = 0; i < lanes; i += turns)
                    for (std::size_t turn = 0; turn < turns; ++turn)
                        parts[turn].add((*column)[i + turn]);
        for (const Hash& part : parts)
            hash.add(part.value());
    }
};

// Neighbouring blocks, which are looked at together where nothing happens to any of them.
struct BlockGroup {
    static constexpr std::size_t size = 8;  // blocks of a group, but for the last

    Box box;                // around the boxes of its blocks; kept up only while none of them touches
    bool touching = false;  // any of them?
    bool slack = false;     // the same

    // `first`: of the group.
    void add(const TrussBlockState& block, bool first) {
        box = first ? block.box : box.with(block.box);
        touching |= block.touching;
        slack |= block.slack;
    }
};

}  // namespace birm3d
