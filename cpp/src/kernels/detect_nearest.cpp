#include "base/block_loop.hpp"
#include "geometry/post_nearest.hpp"
#include "kernels/detect_block.hpp"

namespace birm3d {

namespace {

BIRM3D_BLOCK_LOOP void to_plane(double nx, double ny, double nz, double offset, const BlockColumn& x,
                                const BlockColumn& y, const BlockColumn& z, NearestOfBlock& out) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        out.gap[i] = nx * x[i] + ny * y[i] + nz * z[i] - offset;
        out.nx[i] = nx;
        out.ny[i] = ny;
        out.nz[i] = nz;
    }
}

BIRM3D_BLOCK_LOOP void to_post(const PlainPlacement& t, double radius, double height, const BlockColumn& x,
                               const BlockColumn& y, const BlockColumn& z, NearestOfBlock& out) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double px = t.xx * x[i] + t.xy * y[i] + t.xz * z[i] + t.x;
        const double py = t.yx * x[i] + t.yy * y[i] + t.yz * z[i] + t.y;
        const double pz = t.zx * x[i] + t.zy * y[i] + t.zz * z[i] + t.z;
        double gap, nx, ny, nz;
        nearest_of_post(radius, height, px, py, pz, gap, nx, ny, nz);
        out.gap[i] = gap;
        out.nx[i] = t.xx * nx + t.yx * ny + t.zx * nz;
        out.ny[i] = t.xy * nx + t.yy * ny + t.zy * nz;
        out.nz[i] = t.xz * nx + t.yz * ny + t.zz * nz;
    }
}

struct Block {
    const Placement &now, &before;
    const BlockColumn &x, &y, &z;
    NearestOfBlock& out;
    const BlockColumn* force;

    void operator()(const HalfSpace& shape) const {
        const HalfSpace plane = now.plane_from_own(shape);
        to_plane(plane.normal.x(), plane.normal.y(), plane.normal.z(), plane.offset, x, y, z, out);
    }
    void operator()(const Post& post) const {
        to_post(plain_placement(now), post.radius, post.height, x, y, z, out);
    }
    void operator()(const Prism& prism) const { nearest_of_prism(prism, now, x, y, z, force, out); }
    void operator()(const TriangleMesh& mesh) const { nearest_of_mesh(mesh, now, before, x, y, z, out); }
};

}  // namespace

void nearest_of(const Shape& shape, const Placement& now, const Placement& before, const BlockColumn& x,
                const BlockColumn& y, const BlockColumn& z, NearestOfBlock& out, const BlockColumn* force) {
    std::visit(Block{now, before, x, y, z, out, force}, shape);
}

}  // namespace birm3d
