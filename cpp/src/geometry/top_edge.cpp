#include "birm3d/geometry/top_edge.hpp"

#include "birm3d/base/error.hpp"
#include "geometry/prism_nearest.hpp"

namespace birm3d {

TopEdge top_edge_of(const Prism& prism) {
    // The outward normal of an edge is (tz, -tx).
    for (const PrismEdge& edge : prism.edges())
        if (edge.tz == -1.0) return {edge.x, prism.y_low(), prism.y_high(), edge.z_high};
    refuse("prism", "one with a vertical face towards -x", "a prism without one");
}

}  // namespace birm3d
