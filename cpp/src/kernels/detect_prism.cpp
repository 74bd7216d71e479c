// Prisms: edges of the profile that can be nearest to no node of the block are left out.
#include <algorithm>
#include <array>
#include <vector>

#include "geometry/prism_range.hpp"
#include "kernels/detect_block.hpp"
#include "kernels/simd_table.hpp"

namespace birm3d {

namespace {

// Some edges, copied together in their order.
class SomeEdges {
  public:
    static constexpr std::size_t most = 16;

    SomeEdges() = default;
    SomeEdges(const SomeEdges&) = delete;
    SomeEdges& operator=(const SomeEdges&) = delete;
    void add(const PrismEdge& edge) { near_[list_.count++] = edge; }
    void take_all(const std::vector<PrismEdge>& edges) { list_ = {edges.data(), edges.size()}; }
    EdgeList list() const { return list_; }

  private:
    std::array<PrismEdge, most> near_;
    EdgeList list_{near_.data(), 0};
};

class EdgesInView {
  public:
    // If there are more edges than SomeEdges::most, none is left out.
    EdgesInView(const std::vector<PrismEdge>& edges, const Rectangle& block)
        : edges_(edges), all_(edges.size() > SomeEdges::most) {
        if (all_) return;
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const SquareRange range = distances(edges[e], block);
            least_[e] = range.least;
            most_ = std::min(most_, range.most);
        }
    }

    // Upper bound, for all nodes, of the square of the distance to the nearest edge (m^2).
    double most() const {
        constexpr double rounding = 1.0 + 1e-9;
        return rounding * most_;
    }

    // Edges that are within this squared distance of any node.
    EdgeList within(double most) {
        if (all_) near_.take_all(edges_);
        for (std::size_t e = 0; e < edges_.size() && !all_; ++e)
            if (least_[e] <= most) near_.add(edges_[e]);
        return near_.list();
    }

    // Edges that lines from some nodes along +x cross, and lines from others may not. Reverses `side` for each edge
    // that all of the lines cross.
    EdgeList splitting(const Rectangle& block, double& side) {
        if (all_) splitting_.take_all(edges_);
        for (std::size_t e = 0; e < edges_.size() && !all_; ++e) {
            const Crossing crossing = crossing_of(edges_[e], block);
            if (crossing == Crossing::some) splitting_.add(edges_[e]);
            if (crossing == Crossing::all) side = -side;
        }
        return splitting_.list();
    }

  private:
    const std::vector<PrismEdge>& edges_;
    bool all_;
    double most_ = infinity;
    std::array<double, SomeEdges::most> least_;
    SomeEdges near_, splitting_;
};

}  // namespace

void nearest_of_prism(const Prism& prism, const Placement& now, const BlockColumn& x, const BlockColumn& y,
                      const BlockColumn& z, const BlockColumn* force, NearestOfBlock& out) {
    const PlainPlacement placed = plain_placement(now);
    OwnNodes own;
    const auto [low, high] = to_own(placed, x, y, z, own);
    const Rectangle block{low[0], high[0], low[2], high[2]};
    EdgesInView faces(prism.edges(), block), covered(prism.covered_edges(), block);
    // An end that is further away than a face is nearest to no node.
    const double most = faces.most();
    const auto is_near = [most](double distance) { return distance <= 0.0 || distance * distance <= most; };

    PrismView view;
    view.y_low = prism.y_low();
    view.y_high = prism.y_high();
    view.low_end = prism.low_end_is_surface() && is_near(low[1] - prism.y_low());
    view.high_end = prism.high_end_is_surface() && is_near(prism.y_high() - high[1]);
    view.faces = faces.within(most);
    if (view.low_end || view.high_end) view.covered = covered.within(most);
    view.splitting = faces.splitting(block, view.side);
    view.covered_splitting = covered.splitting(block, view.side);
    view.force = force ? force->data() : nullptr;
    simd.ask_prism(view, placed, {own.x.data(), own.y.data(), own.z.data()}, out.gap.data(),
                   {out.nx.data(), out.ny.data(), out.nz.data()});
}

}  // namespace birm3d
