// A prepared vehicle as text: what Python's Vehicle.export_core() writes, read without Python.
//
// The text holds what the core needs of each unit: its trusses and mass properties. So the vehicle that is read gives
// the same bits as the one in Python. Words are separated by spaces or line ends. A number is hexadecimal as C's %a
// writes it (0x1.8p+3), inf, or a whole number: no rounding and no locale come between. Lengths are in m; n rows
// follow each count.
//
//   birm3d-vehicle 8
//   cornering_stiffness c         1/rad, of its tyres
//   edge_flank_factor k
//   units u
//     mass m                      kg
//     inertia                     nine numbers, about the mass centre, body axes (kg m^2)
//     mass_center_height h        above the ground at rest
//     offset x y z                of the mass centre from the vehicle's reference point; z is 0
//     wheels n                    rows: centre (3), radius, breakaway load (N), travel, stiffness (N/m), damping (N s/m),
//                                 compression at rest, bump travel, roll ratio, steering time (s), tread radius, camber ratio, rolling
//                                 resistance per load; body axes
//     boxes n                     rows: centre (3), half edges (3) of the rigid body's boxes; body axes
//     mesh_origin x y z           of the body axes, in the axes of the mesh
//     mesh_wheels n               rows as above, in the axes of the mesh
//     rate_sensitivity c          s/m
//     indentation_length l
//     curves n                    each: points k_unloading recovery friction_share springback, then rows:
//                                 deflection, slope from there on
//     trusses n                   rows: node (3), anchor (3), curve, scale, wheel or -1, skin node or -1 (see TrussInput)
//   joints j
//     rows: fifth_wheel, welded or sliding, leading unit, trailing unit, place on each (3 + 3), roll limit (rad)
//     of a sliding one then: slide N, and N rows of slip (m) and the force held there (N)
//   end
#pragma once

#include <string_view>

#include "birm3d/model/vehicle.hpp"

namespace birm3d {

// Refuses text that is not of this form, naming the line, and numbers that no vehicle can have.
Vehicle vehicle_of_text(std::string_view text);

}  // namespace birm3d
