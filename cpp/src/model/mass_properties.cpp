#include "birm3d/model/mass_properties.hpp"

#include <string>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d {

double solid_volume(const Hexahedron& solid, std::size_t index) {
    const std::string name = "solid[" + std::to_string(index) + "]";
    for (const Vec3& node : solid)
        if (!node.allFinite()) refuse(name + " nodes", "finite", "a coordinate that is not");
    double volume = 0.0;
    for (const Tetrahedron& part : split(solid)) {
        const double part_volume = signed_volume(part);
        if (!(part_volume > tolerance::solid_volume))
            refuse(name + " volume of each of its six tetrahedra",
                   "> " + to_text(tolerance::solid_volume) +
                       " m^3 (nodes 0-3 counter-clockwise below, 4-7 above)",
                   part_volume);
        volume += part_volume;
    }
    return volume;
}

MassProperties mass_properties(std::span<const Hexahedron> solids, std::span<const double> densities) {
    if (solids.size() != densities.size())
        refuse("densities", "one for each of the " + std::to_string(solids.size()) + " solids",
               static_cast<double>(densities.size()));

    MassProperties total;
    Vec3 first_moment = Vec3::Zero();
    for (std::size_t i = 0; i < solids.size(); ++i) {
        require_not_negative(("densities[" + std::to_string(i) + "]").c_str(), densities[i]);
        solid_volume(solids[i], i);
        for (const Tetrahedron& part : split(solids[i])) {
            const double mass = densities[i] * signed_volume(part);
            total.mass += mass;
            first_moment += mass * centroid(part);
        }
    }
    if (!(total.mass > 0.0)) refuse("mass of the solids", "> 0", total.mass);
    total.center_of_mass = first_moment / total.mass;

    for (std::size_t i = 0; i < solids.size(); ++i) {
        for (const Tetrahedron& part : split(solids[i])) {
            const double mass = densities[i] * signed_volume(part);
            const Vec3 arm = centroid(part) - total.center_of_mass;
            // Eq. 6-7: the part's own inertia and its translation to the body's mass centre.
            total.inertia += densities[i] * central_inertia(part) +
                             mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
        }
    }
    return total;
}

}  // namespace birm3d
