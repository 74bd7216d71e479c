// Mass properties of a rigid body made of 8-node solids with their own densities (paper Eq. 6-7).
//
// Deviation from the paper: Eq. 7 defines the translation matrix I_T, not I_g.
#pragma once

#include <span>

#include "birm3d/geometry/solid.hpp"

namespace birm3d {

struct MassProperties {
    double mass = 0.0;                   // kg
    Vec3 center_of_mass = Vec3::Zero();  // m, in the axes of the solids' nodes
    Mat3 inertia = Mat3::Zero();         // kg m^2, about the mass centre
};

// Refused: densities that are not finite and >= 0, solids of which a tetrahedron has no positive volume
// (inverted, degenerate or too warped), and a body without mass.
MassProperties mass_properties(std::span<const Hexahedron> solids, std::span<const double> densities);

// The volume of one solid (m^3); `index` names it in the message when it is refused.
double solid_volume(const Hexahedron& solid, std::size_t index);

}  // namespace birm3d
