#include <algorithm>
#include <array>
#include <limits>
#include <vector>

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

BIRM3D_LANE_LOOP void ask_edge(const PrismEdge& edge, const OwnLanes& own, EdgeLanes& best) {
    const PrismEdge e = edge;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const NearestEdge b = nearer_edge(
            e, own.x[i], own.z[i], {best.square[i], best.ahead[i], best.past[i], best.tx[i], best.tz[i]});
        best.square[i] = b.square;
        best.ahead[i] = b.ahead;
        best.past[i] = b.past;
        best.tx[i] = b.tx;
        best.tz[i] = b.tz;
    }
}

BIRM3D_LANE_LOOP void cross_edge(const PrismEdge& edge, const OwnLanes& own, Lanes& side) {
    const PrismEdge e = edge;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        side[i] = side_after_edge(e, own.x[i], own.z[i], side[i]);
}

void cross_edges(const std::vector<PrismEdge>& edges, const OwnLanes& own, const Rectangle& block,
                 Lanes& side) {
    for (const PrismEdge& edge : edges)
        if (block.z_low < edge.z_high && block.z_high >= edge.z_low) cross_edge(edge, own, side);
}

// Asks those edges that can be the nearest to some point of the block: the result is that of all. `most`: square of a
// distance that no point is further from the edges asked before.
void ask_edges(const std::vector<PrismEdge>& edges, const OwnLanes& own, const Rectangle& block, double& most,
               Lanes& side, EdgeLanes& best) {
    constexpr double rounding = 1.0 + 1e-9;
    std::array<double, 16> least{};  // of the first edges; the others are asked anyway
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const SquareRange range = distances(edges[e], block);
        most = std::min(most, rounding * range.most);
        if (e < least.size()) least[e] = range.least;
    }
    for (std::size_t e = 0; e < edges.size(); ++e)
        if (e >= least.size() || least[e] <= most) ask_edge(edges[e], own, best);
    cross_edges(edges, own, block, side);
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
        EdgeLanes faces;
        alignas(64) Lanes side;
        to_own(turn, x, y, z, own);
        begin_prism(faces, side);
        Rectangle block;
        double y_low, y_high;
        extent(own.x, block.x_low, block.x_high);
        extent(own.y, y_low, y_high);
        extent(own.z, block.z_low, block.z_high);
        double most = std::numeric_limits<double>::infinity();
        ask_edges(prism.edges(), own, block, most, side, faces);
        // An end that is further away than a face is nearest to no point.
        const auto is_far = [most](double distance) { return distance > 0.0 && distance * distance > most; };
        const bool low_end = prism.low_end_is_surface() && !is_far(y_low - prism.y_low()),
                   high_end = prism.high_end_is_surface() && !is_far(prism.y_high() - y_high);
        EdgeLanes with_covered;
        EdgeLanes* outline = &faces;
        if (low_end || high_end) {
            with_covered = faces;
            outline = &with_covered;
            ask_edges(prism.covered_edges(), own, block, most, side, *outline);
        } else {
            cross_edges(prism.covered_edges(), own, block, side);
        }
        finish_prism(turn, prism.y_low(), prism.y_high(), low_end, high_end, own, side, faces, *outline, out);
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
