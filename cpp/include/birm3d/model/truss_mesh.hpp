// The crushable skin of one rigid unit: massless shell nodes, each tied by one truss to an anchor on the
// rigid body (paper 4.1). Constant, in the order the kernels walk it.
//
// Trusses are sorted into blocks of `block_size` neighbours. Neighbours touch a barrier together. One test tells that
// a whole block touches nothing, and kernels run over whole blocks without gathers. Groups of blocks are tested
// first. The last block is padded with trusses of no stiffness.
//
// A panel may also resist along the vehicle, or across it where its trusses slant. Its nodes then have second trusses,
// each with a node of its own at the same place. That node meets the same surfaces as the first one. One whose truss
// goes along belongs to no panel: posts push on it, but their indentations do not move it. One whose truss goes across
// belongs to that side. The anchor of a second truss is no part of the rigid body. The blocks of second trusses follow
// those of the skin.
//
// Tyres that meet a barrier have nodes too, on the tread's outer edge. The nodes of each wheel have padded blocks of
// their own, after all others. Their anchors meet nothing, as they are no part of the rigid body. The wheels
// themselves meet the ground (kernels/tires.hpp), not these nodes. Posts do not indent tyres.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "birm3d/base/block.hpp"
#include "birm3d/base/types.hpp"
#include "birm3d/geometry/box.hpp"
#include "birm3d/model/truss_law.hpp"
#include "birm3d/model/wheel.hpp"

namespace birm3d {

// A column that copies of a mesh share: filled once, before there is a copy.
template <class T>
class SharedColumn {
  public:
    std::vector<T>& fill() { return *values_; }
    const T& operator[](std::size_t i) const { return (*values_)[i]; }
    std::size_t size() const { return values_->size(); }
    bool empty() const { return values_->empty(); }
    const T* data() const { return values_->data(); }
    auto begin() const { return values_->cbegin(); }
    auto end() const { return values_->cend(); }

  private:
    std::shared_ptr<std::vector<T>> values_ = std::make_shared<std::vector<T>>();
};

// The arguments of a mesh: one curve for many trusses, scaled by each truss's tributary area (or by 1).
struct TrussInput {
    std::vector<Vec3> node;             // (n) body axes, origin at the mass centre (m)
    std::vector<Vec3> anchor;           // (n) the same
    std::vector<TrussCurve> curve;      // (c)
    std::vector<std::size_t> curve_of;  // (n) index into curve
    std::vector<double> scale;          // (n) tributary area (m^2), or 1 for curves per truss
    // What is crushed has inertia and rate strength, which the law of Fig. 3 leaves out: the loading envelope
    // is multiplied by 1 + (this times the rate of deflection)^2; in s/m.
    double rate_sensitivity = 0.0;
    // How far beyond a post its indentation extends (kernels/indentation.hpp); zero: nodes move independently of each
    // other (m).
    double indentation_length = 0.0;
    // (n) Number of the wheel whose tread the node is on, -1 for the skin; empty: all skin.
    std::vector<int> wheel_of = {};
    // (n) Number of the node of the skin whose second truss this is, along the vehicle or across it; -1 for others; empty: no
    // second ones.
    std::vector<int> along_of = {};
};

// Unloading stiffness of some trusses and its second moments about the mass centre, body axes.
struct StiffnessMoments {
    double total = 0.0;          // sum of k (N/m)
    Mat3 second = Mat3::Zero();  // sum of k r r^T (N m)
};

// The part of a skin whose trusses point in, more than in any other way, along +r, -r, +s, -s, +t or -t.
struct Panel {
    Vec3 inward;                     // that axis
    Box box;                         // around its uncrushed nodes
    Box anchors;                     // and where they are anchored
    bool any;                        // has it any?
    std::vector<Box> outlines = {};  // each around the nodes up to one outline_step further in than the last
};
inline constexpr double outline_step = 0.1;  // m

// Of a panel with these nodes (body axes) and that axis.
std::vector<Box> outlines_of(std::vector<Vec3> nodes, const Vec3& inward);

// Box around the nodes of a panel that are no deeper than `depth` behind its foremost one. A depth below outline_step counts
// as that. Between the outlines it is linear in `depth`. A bumper is narrower than the body behind it.
Box outline_at(const Panel& panel, double depth);

// Height of each of a panel's nodes (body axes) above the panel's lowest node within column_half_width to either side (m). Zero for
// panels that look up or down.
std::vector<double> heights_above_edge(const std::vector<Vec3>& nodes, const Vec3& inward);
inline constexpr double column_half_width = 0.2;  // m

inline constexpr std::size_t panels = 6;

struct alignas(64) TrussBlock {
    BlockColumn node_x, node_y, node_z;        // uncrushed, body axes (m)
    BlockColumn anchor_x, anchor_y, anchor_z;  // (m)
    BlockColumn length;                        // uncrushed (m)
    BlockColumn k_unloading;                   // N/m
    BlockColumn compliance;                    // 1/k_unloading, or 0 for a truss without stiffness (m/N)
    BlockColumn recovery;                      // of its curve, see has_recovery() (m)
    BlockColumn panel;                         // number of its panel
    BlockColumn height_above_edge;             // of its node, see heights_above_edge() (m)
};

// Anchor of the i-th truss of a block, body axes (m).
inline Vec3 anchor_of(const TrussBlock& truss, std::size_t i) {
    return {truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]};
}

// Of the trusses of a block.
StiffnessMoments stiffness_of(const TrussBlock& trusses);

// One slope change of each truss's envelope.
struct alignas(64) Hinge {
    BlockColumn deflection;    // m
    BlockColumn slope_change;  // N/m
};

// What a tire contact node has in addition. At a rolling speed v, the tread at the place d from the axle moves with v
// (s x d)/R relative to the body.
struct TireNode {
    double tread_r = 0.0, tread_t = 0.0;  // (s x d)/R
    std::size_t wheel = 0;                // of the unit
};

struct TrussMesh {
    // Refuses what is not as TrussInput says; `wheels` are those that wheel_of counts.
    explicit TrussMesh(const TrussInput& input, const std::vector<Wheel>& wheels = {});

    // The same trusses seen from `origin`, a point of these axes. Numbers and order are those that the constructor would
    // make of the moved input, up to rounding; what does not change is shared.
    TrussMesh moved(const Vec3& origin) const;

    std::size_t count = 0;        // trusses
    std::size_t skin = 0;         // those that tie the skin to the rigid body
    std::size_t shell = 0;        // and second ones, before those of tyres
    std::size_t blocks = 0;       // blocks of `block_size`
    std::size_t skin_blocks = 0;  // the first of them
    std::size_t shell_blocks = 0;
    std::size_t hinges = 0;  // slope changes of the longest envelope
    bool recovers = false;  // has any curve a recovery? Then coefficients of unloading are part of the state.

    static constexpr std::size_t group_size = 8;  // blocks of a group, but for the last
    std::size_t end_of_group(std::size_t g) const { return std::min((g + 1) * group_size, blocks); }

    SharedColumn<std::size_t> first;  // (blocks + 1) truss of each block, and the end
    SharedColumn<TrussBlock> block;   // (blocks)
    SharedColumn<Hinge> hinge;        // (blocks * hinges), a block's hinges together

    SharedColumn<double> pushable;             // (blocks) trusses that have a stiffness
    SharedColumn<StiffnessMoments> moments;    // (blocks) of all of them
    SharedColumn<Box> node_box;                // (blocks) around the uncrushed nodes
    SharedColumn<Box> anchor_box;              // (blocks)
    SharedColumn<TireNode> tire_nodes;         // (count - shell)
    SharedColumn<BlockColumn> friction_share;  // (blocks), see TrussCurve; empty where all have the whole
    SharedColumn<BlockColumn>
        springback;  // (blocks), of each node, see TrussCurve; empty where none has any (m)
    Box anchors;     // around those of the skin
    std::array<Panel, panels> panel;
    // (blocks) bit by bit: which panels have nodes there? The bit after them: treads.
    SharedColumn<std::uint8_t> panels_of;
    SharedColumn<std::uint8_t> panels_of_group;  // (groups) the same
    SharedColumn<std::size_t> input_index;       // (count) the caller's number of each truss

    // Place of a truss in the blocks: padding stands between some.
    std::size_t slot(std::size_t truss) const {
        const auto after = std::upper_bound(first.begin(), first.end(), truss);
        const auto b = static_cast<std::size_t>(after - first.begin()) - 1;
        return b * block_size + (truss - first[b]);
    }
    // Nodes in a block, without its padding.
    std::size_t nodes_in(std::size_t b) const { return first[b + 1] - first[b]; }
    Vec3 node(std::size_t truss) const {
        const TrussBlock& b = block[slot(truss) / block_size];
        const std::size_t i = slot(truss) % block_size;
        return {b.node_x[i], b.node_y[i], b.node_z[i]};
    }
    Vec3 anchor(std::size_t truss) const {
        return anchor_of(block[slot(truss) / block_size], slot(truss) % block_size);
    }

    double rate_sensitivity = 0.0;    // see TrussInput (s/m)
    double indentation_length = 0.0;  // see TrussInput

    double reach = 0.0;  // greatest distance of a node, or an anchor of the skin, from the mass centre (m)

  private:
    void fill_block(const TrussInput& input, std::size_t b);
    void find_springback(const TrussInput& input);
    void find_panels(const TrussInput& input);
    void find_tread(const TrussInput& input, const std::vector<Wheel>& wheels);
    void pad(const TrussInput& input, std::size_t b);
    void fill_slot(const TrussInput& input, std::size_t source, std::size_t b, std::size_t i);
    void place_slot(const Vec3& node, const Vec3& anchor, std::size_t b, std::size_t i);
};

}  // namespace birm3d
