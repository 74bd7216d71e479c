// The straight upper edge of a vertical face. Like a post, it draws in the skin above it: see kernels/indentation.hpp.
#pragma once

#include "birm3d/geometry/prism.hpp"

namespace birm3d {

// In the own axes of a prism whose face looks to -x (m).
struct TopEdge {
    double x;          // of the face
    double low, high;  // its ends along y, which may be infinite
    double height;     // z of the edge
};

// The edge of the vertical face of a prism that looks to -x. Refuses a prism without such a face that has an end above.
TopEdge top_edge_of(const Prism& prism);

}  // namespace birm3d
