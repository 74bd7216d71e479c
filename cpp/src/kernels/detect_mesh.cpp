// Meshes: the tree is walked once for the whole block, and each triangle met is tried on all nodes at a time. If the
// triangles are small relative to the block, that would be too many: then each node searches the tree alone.
#include <cmath>

#include "base/block_loop.hpp"
#include "geometry/triangle_mesh_data.hpp"
#include "kernels/detect_block.hpp"

namespace birm3d {

namespace {

// Most triangles that are tried on whole blocks; measured to be fastest.
constexpr std::size_t most_triangles = 32;

// The nearest triangle of each node so far.
struct alignas(64) NearestTriangles {
    BlockColumn square, x, y, z, part;  // as OnTriangle
    BlockColumn index;                  // of the triangle
};

BIRM3D_BLOCK_LOOP void begin(double square, NearestTriangles& best) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        best.square[i] = square;
        best.x[i] = best.y[i] = best.z[i] = best.part[i] = best.index[i] = 0.0;
    }
}

// Returns the largest square of a distance that is left.
BIRM3D_BLOCK_LOOP double ask_triangle(const PlainTriangle& triangle, double index, const OwnNodes& own,
                                      NearestTriangles& best) {
    const PlainTriangle t = triangle;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const OnTriangle on = nearest_on_plain(t, own.x[i], own.y[i], own.z[i]);
        const bool nearer = on.square < best.square[i];
        best.square[i] = nearer ? on.square : best.square[i];
        best.x[i] = nearer ? on.x : best.x[i];
        best.y[i] = nearer ? on.y : best.y[i];
        best.z[i] = nearer ? on.z : best.z[i];
        best.part[i] = nearer ? on.part : best.part[i];
        best.index[i] = nearer ? index : best.index[i];
    }
    alignas(64) BlockColumn squares = best.square;
    return block_max(squares);
}

}  // namespace

void nearest_of_mesh(const TriangleMesh& mesh, const Placement& now, const Placement& before,
                     const BlockColumn& x, const BlockColumn& y, const BlockColumn& z, NearestOfBlock& out) {
    const TriangleMeshData& data = mesh.data();
    OwnNodes own;
    const Extent extent = to_own(plain_placement(now), x, y, z, own);
    const Eigen::Map<const Vec3> low(extent.low), high(extent.high);
    const Vec3 middle = 0.5 * (low + high);

    // The triangle nearest to the middle of the block is near all of it.
    std::size_t hint = 0;
    mesh.nearest(middle, hint);
    NearestTriangles best;
    begin(infinity, best);
    double most = ask_triangle(data.triangles[hint].plain, static_cast<double>(hint), own, best);
    std::size_t asked = 1;
    data.tree.near(low, high, most, [&](std::size_t i) {
        if (i == hint || asked > most_triangles) return;
        most = ask_triangle(data.triangles[i].plain, static_cast<double>(i), own, best);
        if (++asked > most_triangles) most = 0.0;  // ends the walk
    });
    const bool all_asked = asked <= most_triangles;

    for (std::size_t i = 0; i < block_size; ++i) {
        const Vec3 p(own.x[i], own.y[i], own.z[i]);
        auto triangle = static_cast<std::size_t>(best.index[i]);
        const OnTriangle on{best.square[i], best.x[i], best.y[i], best.z[i], best.part[i]};
        const Nearest exact =
            all_asked ? nearest_from(data.triangles[triangle], on, p) : mesh.nearest(p, triangle);
        const Vec3 motion = p - before.to_own({x[i], y[i], z[i]});
        const Nearest n = mesh.contact(p, motion, exact);
        const Vec3 normal = now.direction_from_own(n.normal);
        out.gap[i] = n.gap;
        out.nx[i] = normal.x();
        out.ny[i] = normal.y();
        out.nz[i] = normal.z();
    }
}

}  // namespace birm3d
