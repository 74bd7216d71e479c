// Compiled once for each instruction set; see base/packet.hpp for what that forbids.
#include "kernels/detect_simd.hpp"

#include "base/packet.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

struct Spread {
    Packet low = infinitely_far, high = -infinitely_far;
    BIRM3D_INLINE void add(const Packet& row) { low = lesser(row, low), high = greater(row, high); }
    BIRM3D_INLINE void finish(double& least, double& most) const {
        least = least_of(low);
        most = -least_of(-1.0 * high);
    }
};

struct Spreads {
    Spread x, y, z;
    BIRM3D_INLINE void finish(Extent& extent) const {
        x.finish(extent.low[0], extent.high[0]);
        y.finish(extent.low[1], extent.high[1]);
        z.finish(extent.low[2], extent.high[2]);
    }
};

BIRM3D_INLINE Packet cross(const EdgeList& edges, const Packet& x, const Packet& z, Packet side) {
    for (std::size_t e = 0; e < edges.count; ++e)
        side = side_after_edge(edges.edge[e], x, z, side);
    return side;
}

BIRM3D_INLINE NearestEdge<Packet> nearest_edge(const EdgeList& edges, const Packet& x, const Packet& z,
                                               NearestEdge<Packet> best) {
    for (std::size_t e = 0; e < edges.count; ++e)
        best = nearer_edge(edges.edge[e], x, z, best);
    return best;
}

// `count`: number of faces, so that what is known of them stays in registers; 0: any number.
template <std::size_t count>
BIRM3D_INLINE void ask(const PrismView& prism, const PlainPlacement& t, const Points& own, double* gap,
                       const Columns& normals) {
    EdgeList faces = prism.faces;
    if constexpr (count > 0) faces.count = count;
    const Packet zero = 0.0, one = 1.0;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        const Packet x = Packet::load(own.x + i), y = Packet::load(own.y + i), z = Packet::load(own.z + i);
        const Packet side = cross(prism.covered_splitting, x, z, cross(prism.splitting, x, z, prism.side));
        const Packet past_end = past_ends(y, prism.y_low, prism.y_high),
                     sign = side_with_ends(side, past_end);
        if (prism.force != nullptr &&
            !any_above(where_above(Packet::load(prism.force + i), zero, one, -1.0 * sign), zero)) {
            Packet(infinitely_far).store(gap + i);
            continue;
        }
        const NearestEdge<Packet> face = nearest_edge(faces, x, z, {});
        FromSurface<Packet> v = from_edge(face, past_end);
        if (prism.low_end || prism.high_end) {
            const NearestEdge<Packet> outline = nearest_edge(prism.covered, x, z, face);
            if (prism.low_end) v = nearer_end<Packet>(outline, side, y - prism.y_low, -1.0, v);
            if (prism.high_end) v = nearer_end<Packet>(outline, side, y - prism.y_high, 1.0, v);
        }
        Packet distance, nx, ny, nz;
        signed_distance(v, sign, distance, nx, ny, nz);
        distance.store(gap + i);
        (t.xx * nx + t.yx * ny + t.zx * nz).store(normals.x + i);
        (t.xy * nx + t.yy * ny + t.zy * nz).store(normals.y + i);
        (t.xz * nx + t.yz * ny + t.zz * nz).store(normals.z + i);
    }
}

}  // namespace

void place_nodes(const PlainPlacement& placed, const Points& nodes, const Columns& own, Extent& extent);
void find_extent(const Points& nodes, Extent& extent);
void ask_prism(const PrismView& prism, const PlainPlacement& placed, const Points& own, double* gap,
               const Columns& normals);

void place_nodes(const PlainPlacement& t, const Points& nodes, const Columns& own, Extent& extent) {
    Spreads spreads;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        const Packet x = Packet::load(nodes.x + i), y = Packet::load(nodes.y + i),
                     z = Packet::load(nodes.z + i);
        const Packet own_x = t.xx * x + t.xy * y + t.xz * z + t.x;
        const Packet own_y = t.yx * x + t.yy * y + t.yz * z + t.y;
        const Packet own_z = t.zx * x + t.zy * y + t.zz * z + t.z;
        own_x.store(own.x + i);
        own_y.store(own.y + i);
        own_z.store(own.z + i);
        spreads.x.add(own_x);
        spreads.y.add(own_y);
        spreads.z.add(own_z);
    }
    spreads.finish(extent);
}

void find_extent(const Points& nodes, Extent& extent) {
    Spreads spreads;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        spreads.x.add(Packet::load(nodes.x + i));
        spreads.y.add(Packet::load(nodes.y + i));
        spreads.z.add(Packet::load(nodes.z + i));
    }
    spreads.finish(extent);
}

void ask_prism(const PrismView& prism, const PlainPlacement& placed, const Points& own, double* gap,
               const Columns& normals) {
    switch (prism.faces.count) {
        case 1:
            return ask<1>(prism, placed, own, gap, normals);
        case 2:
            return ask<2>(prism, placed, own, gap, normals);
        case 3:
            return ask<3>(prism, placed, own, gap, normals);
        default:
            return ask<0>(prism, placed, own, gap, normals);
    }
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
