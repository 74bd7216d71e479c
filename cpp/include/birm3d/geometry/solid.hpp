// Mass integrals of tetrahedra (paper Eq. 2-5) and of 8-node solids split into six of them (Fig. 4).
//
// Deviations from the paper: Eq. 3's determinant is signed by the order of the vertices; here the order of
// a solid's nodes is checked and an inverted solid is refused. Eq. 4-5 as printed hold for vertex positions
// k_i taken from the tetrahedron's mass centre.
#pragma once

#include <array>

#include "birm3d/base/types.hpp"

namespace birm3d {

using Tetrahedron = std::array<Vec3, 4>;

// Node order: 0-3 around the lower face, 4-7 above them; counter-clockwise seen from above (from node 4).
using Hexahedron = std::array<Vec3, 8>;

Vec3 centroid(const Tetrahedron& t);         // Eq. 2 (m)
double signed_volume(const Tetrahedron& t);  // Eq. 3 (m^3), positive for a right-handed vertex order

// Eq. 4-5: inertia about the tetrahedron's own mass centre, for unit density (m^5).
Mat3 central_inertia(const Tetrahedron& t);

// Fig. 4: six tetrahedra that fill the solid and share its diagonal 0-6.
std::array<Tetrahedron, 6> split(const Hexahedron& h);

}  // namespace birm3d
