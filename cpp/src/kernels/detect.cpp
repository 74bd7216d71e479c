#include "birm3d/kernels/detect.hpp"

namespace birm3d {

namespace {

BIRM3D_LANE_LOOP void detect_plane(double nx, double ny, double nz, double offset, const Lanes& x,
                                   const Lanes& y, const Lanes& z, BlockContact& contact) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        contact.gap[i] = nx * x[i] + ny * y[i] + nz * z[i] - offset;
        contact.normal_x[i] = nx;
        contact.normal_y[i] = ny;
        contact.normal_z[i] = nz;
    }
}

}  // namespace

void detect(const HalfSpace& face, const Lanes& x, const Lanes& y, const Lanes& z, BlockContact& contact) {
    detect_plane(face.normal.x(), face.normal.y(), face.normal.z(), face.offset, x, y, z, contact);
}

}  // namespace birm3d
