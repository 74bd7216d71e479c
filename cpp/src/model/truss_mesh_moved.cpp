// The trusses of a vehicle whose mass centre has moved: nothing is cut or sorted again.
#include <algorithm>
#include <cmath>

#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

namespace {

struct Bounds {
    double low, high;
};

Bounds bounds_of(const Lanes& values) {
    Bounds found{values[0], values[0]};
    for (const double value : values)
        found = {std::min(found.low, value), std::max(found.high, value)};
    return found;
}

Box box_around(const Lanes& x, const Lanes& y, const Lanes& z) {
    const Bounds along_x = bounds_of(x), along_y = bounds_of(y), along_z = bounds_of(z);
    const Vec3 low(along_x.low, along_y.low, along_z.low), high(along_x.high, along_y.high, along_z.high);
    return {0.5 * (low + high), 0.5 * (high - low)};
}

// Greatest squared distance from the origin (m^2).
double reach_squared(const Lanes& x, const Lanes& y, const Lanes& z) {
    double greatest = 0.0;
    for (std::size_t i = 0; i < lanes; ++i)
        greatest = std::max(greatest, x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    return greatest;
}

void move(Lanes& values, double by) {
    for (double& value : values)
        value -= by;
}

}  // namespace

void TrussMesh::move_block(std::size_t b, const Vec3& origin) {
    TrussBlock& to = block[b];
    move(to.node_x, origin.x()), move(to.node_y, origin.y()), move(to.node_z, origin.z());
    move(to.anchor_x, origin.x()), move(to.anchor_y, origin.y()), move(to.anchor_z, origin.z());
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = to.node_x[i] - to.anchor_x[i], y = to.node_y[i] - to.anchor_y[i],
                     z = to.node_z[i] - to.anchor_z[i];
        to.length[i] = std::sqrt(x * x + y * y + z * z);
    }
    node_box[b] = box_around(to.node_x, to.node_y, to.node_z);
    anchor_box[b] = box_around(to.anchor_x, to.anchor_y, to.anchor_z);
    moments[b] = stiffness_of(to);
}

TrussMesh TrussMesh::moved(const Vec3& origin) const {
    TrussMesh mesh = *this;
    if (origin == Vec3::Zero()) return mesh;
    double reach_2 = 0.0;
    for (std::size_t b = 0; b < blocks; ++b) {
        mesh.move_block(b, origin);
        const TrussBlock& at = mesh.block[b];
        reach_2 = std::max(reach_2, reach_squared(at.node_x, at.node_y, at.node_z));
        if (b < skin_blocks)
            reach_2 = std::max(reach_2, reach_squared(at.anchor_x, at.anchor_y, at.anchor_z));
    }
    mesh.reach = std::sqrt(reach_2);
    mesh.anchors.center -= origin;
    for (Panel& of : mesh.panel)
        if (of.any) of.box.center -= origin, of.anchors.center -= origin;
    return mesh;
}

}  // namespace birm3d
