#include "kernels/detect_lanes.hpp"

namespace birm3d {

namespace {

BIRM3D_LANE_LOOP void turn_block(const Turn& t, const Lanes& x, const Lanes& y, const Lanes& z,
                                 OwnLanes& own) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        own.x[i] = t.xx * x[i] + t.xy * y[i] + t.xz * z[i] + t.x;
        own.y[i] = t.yx * x[i] + t.yy * y[i] + t.yz * z[i] + t.y;
        own.z[i] = t.zx * x[i] + t.zy * y[i] + t.zz * z[i] + t.z;
    }
}

BIRM3D_LANE_LOOP void to_plane(double nx, double ny, double nz, double offset, const Lanes& x, const Lanes& y,
                               const Lanes& z, NearestLanes& out) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        out.gap[i] = nx * x[i] + ny * y[i] + nz * z[i] - offset;
        out.nx[i] = nx;
        out.ny[i] = ny;
        out.nz[i] = nz;
    }
}

BIRM3D_LANE_LOOP void to_post(const Turn& t, double radius, double height, const Lanes& x, const Lanes& y,
                              const Lanes& z, NearestLanes& out) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
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

// What is known of the nearest edge of a prism while its edges are asked one after the other.
struct alignas(64) EdgeLanes {
    Lanes square, ahead, past, tx, tz;
};

BIRM3D_LANE_LOOP void begin_prism(EdgeLanes& best, Lanes& side) {
    constexpr NearestEdge nothing{};
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        best.square[i] = nothing.square;
        best.ahead[i] = nothing.ahead;
        best.past[i] = nothing.past;
        best.tx[i] = nothing.tx;
        best.tz[i] = nothing.tz;
        side[i] = 1.0;
    }
}

BIRM3D_LANE_LOOP void ask_edges(const PrismEdge* edges, std::size_t count, const OwnLanes& own, Lanes& side,
                                EdgeLanes& best) {
    for (std::size_t e = 0; e < count; ++e) {
        const PrismEdge edge = edges[e];
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < lanes; ++i) {
            const NearestEdge b =
                nearer_edge(edge, own.x[i], own.z[i],
                            {best.square[i], best.ahead[i], best.past[i], best.tx[i], best.tz[i]});
            best.square[i] = b.square;
            best.ahead[i] = b.ahead;
            best.past[i] = b.past;
            best.tx[i] = b.tx;
            best.tz[i] = b.tz;
            side[i] = side_after_edge(edge, own.x[i], own.z[i], side[i]);
        }
    }
}

BIRM3D_LANE_LOOP void finish_prism(const Turn& t, double y_low, double y_high, bool low_end, bool high_end,
                                   const OwnLanes& own, const Lanes& side, const EdgeLanes& faces,
                                   const EdgeLanes& outline, NearestLanes& out) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double y = own.y[i];
        const double not_below = y > y_low ? y : y_low;
        const double past_end = y - (not_below < y_high ? not_below : y_high);
        const NearestEdge face{faces.square[i], faces.ahead[i], faces.past[i], faces.tx[i], faces.tz[i]};
        const NearestEdge all{outline.square[i], outline.ahead[i], outline.past[i], outline.tx[i],
                              outline.tz[i]};
        FromSurface v = from_edge(face, past_end);
        if (low_end) v = nearer_end(all, side[i], y - y_low, -1.0, v);
        if (high_end) v = nearer_end(all, side[i], y - y_high, 1.0, v);
        double gap, nx, ny, nz;
        signed_distance(v, past_end == 0.0 ? side[i] : 1.0, gap, nx, ny, nz);
        out.gap[i] = gap;
        out.nx[i] = t.xx * nx + t.yx * ny + t.zx * nz;
        out.ny[i] = t.xy * nx + t.yy * ny + t.zy * nz;
        out.nz[i] = t.xz * nx + t.yz * ny + t.zz * nz;
    }
}

struct Block {
    const Placement &now, &before;
    const Lanes &x, &y, &z;
    NearestLanes& out;

    void operator()(const HalfSpace& shape) const {
        const HalfSpace plane = now.plane_from_own(shape);
        to_plane(plane.normal.x(), plane.normal.y(), plane.normal.z(), plane.offset, x, y, z, out);
    }
    void operator()(const Post& post) const { to_post(turn_of(now), post.radius, post.height, x, y, z, out); }
    void operator()(const Prism& prism) const {
        const Turn turn = turn_of(now);
        OwnLanes own;
        EdgeLanes faces, outline;
        alignas(64) Lanes side;
        to_own(turn, x, y, z, own);
        begin_prism(faces, side);
        ask_edges(prism.edges().data(), prism.edges().size(), own, side, faces);
        outline = faces;
        ask_edges(prism.covered_edges().data(), prism.covered_edges().size(), own, side, outline);
        finish_prism(turn, prism.y_low(), prism.y_high(), prism.low_end_is_surface(),
                     prism.high_end_is_surface(), own, side, faces, outline, out);
    }
    void operator()(const TriangleMesh& mesh) const { nearest_of_mesh(mesh, now, before, x, y, z, out); }
};

}  // namespace

void to_own(const Turn& turn, const Lanes& x, const Lanes& y, const Lanes& z, OwnLanes& own) {
    turn_block(turn, x, y, z, own);
}

void nearest_of(const Shape& shape, const Placement& now, const Placement& before, const Lanes& x,
                const Lanes& y, const Lanes& z, NearestLanes& out) {
    std::visit(Block{now, before, x, y, z, out}, shape);
}

}  // namespace birm3d
