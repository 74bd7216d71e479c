// The trusses of a vehicle whose mass centre has moved: nothing is cut or sorted again.
#include <algorithm>
#include <cmath>

#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

namespace {

struct Bounds {
    double low, high;
};

Bounds bounds_of(const BlockColumn& values) {
    Bounds found{values[0], values[0]};
    for (const double value : values)
        found = {std::min(found.low, value), std::max(found.high, value)};
    return found;
}

Box box_of_columns(const BlockColumn& x, const BlockColumn& y, const BlockColumn& z) {
    const Bounds along_x = bounds_of(x), along_y = bounds_of(y), along_z = bounds_of(z);
    const Vec3 low(along_x.low, along_y.low, along_z.low), high(along_x.high, along_y.high, along_z.high);
    return {0.5 * (low + high), 0.5 * (high - low)};
}

// Greatest squared distance from the origin (m^2).
double reach_squared(const BlockColumn& x, const BlockColumn& y, const BlockColumn& z) {
    double greatest = 0.0;
    for (std::size_t i = 0; i < block_size; ++i)
        greatest = std::max(greatest, x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    return greatest;
}

void move(BlockColumn& values, double by) {
    for (double& value : values)
        value -= by;
}

TrussBlock moved_block(const TrussBlock& block, const Vec3& origin) {
    TrussBlock to = block;
    move(to.node_x, origin.x()), move(to.node_y, origin.y()), move(to.node_z, origin.z());
    move(to.anchor_x, origin.x()), move(to.anchor_y, origin.y()), move(to.anchor_z, origin.z());
    for (std::size_t i = 0; i < block_size; ++i) {
        const double x = to.node_x[i] - to.anchor_x[i], y = to.node_y[i] - to.anchor_y[i],
                     z = to.node_z[i] - to.anchor_z[i];
        to.length[i] = std::sqrt(x * x + y * y + z * z);
    }
    return to;
}

// A separate column in place of a shared one.
template <class T>
std::vector<T>& anew(SharedColumn<T>& column, std::size_t size) {
    column = {};
    column.fill().reserve(size);
    return column.fill();
}

}  // namespace

TrussMesh TrussMesh::moved(const Vec3& origin) const {
    TrussMesh mesh = *this;
    if (origin == Vec3::Zero()) return mesh;
    double reach_2 = 0.0;
    std::vector<TrussBlock>& to = anew(mesh.block, blocks);
    std::vector<Box>&nodes = anew(mesh.node_box, blocks), &places = anew(mesh.anchor_box, blocks);
    std::vector<StiffnessMoments>& stiffness = anew(mesh.moments, blocks);
    for (std::size_t b = 0; b < blocks; ++b) {
        to.push_back(moved_block(block[b], origin));
        const TrussBlock& at = to.back();
        nodes.push_back(box_of_columns(at.node_x, at.node_y, at.node_z));
        places.push_back(box_of_columns(at.anchor_x, at.anchor_y, at.anchor_z));
        stiffness.push_back(stiffness_of(at));
        reach_2 = std::max(reach_2, reach_squared(at.node_x, at.node_y, at.node_z));
        if (b < skin_blocks)
            reach_2 = std::max(reach_2, reach_squared(at.anchor_x, at.anchor_y, at.anchor_z));
    }
    mesh.reach = std::sqrt(reach_2);
    mesh.anchors.center -= origin;
    for (Panel& shifted : mesh.panel) {
        if (!shifted.any) continue;
        shifted.box.center -= origin;
        shifted.anchors.center -= origin;
        for (Box& outline : shifted.outlines)
            outline.center -= origin;
    }
    return mesh;
}

}  // namespace birm3d
