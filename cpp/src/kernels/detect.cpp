#include "birm3d/kernels/detect.hpp"

namespace birm3d {

namespace {

BIRM3D_LANE_LOOP void plane_gaps(double nx, double ny, double nz, double offset, const Lanes& x,
                                 const Lanes& y, const Lanes& z, Lanes& gap) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        gap[i] = nx * x[i] + ny * y[i] + nz * z[i] - offset;
}

}  // namespace

Lanes gaps(const Cylinder& face, const Lanes& x, const Lanes& y, const Lanes& z) {
    Lanes gap;
    for (std::size_t i = 0; i < lanes; ++i)
        gap[i] = face.gap({x[i], y[i], z[i]});
    return gap;
}

Lanes gaps(const HalfSpace& face, const Lanes& x, const Lanes& y, const Lanes& z) {
    Lanes gap;
    plane_gaps(face.normal.x(), face.normal.y(), face.normal.z(), face.offset, x, y, z, gap);
    return gap;
}

}  // namespace birm3d
