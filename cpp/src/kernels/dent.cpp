#include "birm3d/kernels/dent.hpp"

#include <cmath>

namespace birm3d {

namespace {

// Cosine above which two trusses belong to one panel.
constexpr double same_panel = 0.9;

struct alignas(64) Directions {
    Lanes x, y, z;
};

BIRM3D_LANE_LOOP void directions_of(const TrussBlock& truss, Directions& to) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double per = 1.0 / truss.length[i];
        to.x[i] = (truss.node_x[i] - truss.anchor_x[i]) * per;
        to.y[i] = (truss.node_y[i] - truss.anchor_y[i]) * per;
        to.z[i] = (truss.node_z[i] - truss.anchor_z[i]) * per;
    }
}

struct Driver {
    double x, y, z, bx, by, bz, deflection, number;
};

BIRM3D_LANE_LOOP void hang_on(const TrussBlock& truss, const Directions& b, double slope, const Driver& d,
                              Lanes& deflection, Lanes& number) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = truss.node_x[i] - d.x, y = truss.node_y[i] - d.y, z = truss.node_z[i] - d.z;
        const double along = b.x[i] * d.bx + b.y[i] * d.by + b.z[i] * d.bz;
        const double drawn = d.deflection - slope * std::sqrt(x * x + y * y + z * z);
        const bool more = along > same_panel && drawn > deflection[i];
        deflection[i] = more ? drawn : deflection[i];
        number[i] = more ? d.number : number[i];
    }
}

}  // namespace

void hang(const TrussBlock& trusses, double slope, std::span<const DentDriver> drivers, Hanging& hanging) {
    alignas(64) Directions directions;
    directions_of(trusses, directions);
    alignas(64) Lanes number{};
    hanging.deflection.fill(-1.0);
    for (std::size_t k = 0; k < drivers.size(); ++k) {
        const DentDriver& d = drivers[k];
        hang_on(trusses, directions, slope,
                {d.place.x(), d.place.y(), d.place.z(), d.direction.x(), d.direction.y(), d.direction.z(),
                 d.deflection, static_cast<double>(k)},
                hanging.deflection, number);
    }
    for (std::size_t i = 0; i < lanes; ++i)
        hanging.driver[i] = static_cast<std::size_t>(number[i]);
}

}  // namespace birm3d
