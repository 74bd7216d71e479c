#include "birm3d/kernels/crush.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "kernels/crush_dispatch.hpp"

namespace birm3d {

namespace {

// Cosine above which the normals of two instants are one surface's.
constexpr double sharp_turn = 0.5;

// Held nodes move along n + m, m the normal of the instant before, so that a path is followed to second order
// while the body turns.
Vec3 holding_direction(const Vec3& n, const Vec3& m) {
    return (n + m) / (1.0 + n.dot(m));
}

// Nodes whose truss ceased to push. One that follows a receding surface stops where its truss reaches zero
// force; one that the truss pushes off the surface springs to that length at once, and what the truss had
// stored is lost. Few nodes a step do. Returns what the first kind takes from the work on the trusses (J).
double release(const TrussBlock& truss, const TrussBlockState& before, const Lanes& gap,
               const BlockContact& contact, TrussBlockState& now) {
    double spared = 0.0;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(before.force[i] > 0.0 && now.force[i] == 0.0)) continue;
        const Vec3 anchor(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
        const Vec3 from(before.x[i], before.y[i], before.z[i]), to(now.x[i], now.y[i], now.z[i]);
        const double d0 = before.deflection[i], d1 = now.deflection[i];
        Vec3 b = to - anchor;
        double d = before.residual[i];
        if (b.dot(contact.normal(i)) < 0.0) {
            if (!(gap[i] > 0.0)) continue;
            const double way = d0 - d1;
            const double share = way > 0.0 ? std::clamp((d0 - d) / way, 0.0, 1.0) : 0.0;
            b = from + share * (to - from) - anchor;
            d = d0 - share * way;
            spared += 0.5 * before.force[i] * (d - d1);
            if ((before.leading >> i & 1U) != 0) continue;  // what hangs on it keeps it at the surface
        } else if (!(d < d1)) {
            continue;  // drawn out beyond its length: back there it would be inside
        }
        const double length = truss.length[i] - d;
        const Vec3 place = anchor + (length > tolerance::truss_length ? length / b.norm() : 1.0) * b;
        now.x[i] = place.x(), now.y[i] = place.y(), now.z[i] = place.z();
        now.deflection[i] = d;
    }
    return spared;
}

BIRM3D_LANE_LOOP double stiffness_of_pushing(const TrussBlock& truss, const Lanes& force, double constant,
                                             double xx, double yy, double zz, double xy, double xz,
                                             double yz) {
    alignas(64) Lanes sum;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = truss.node_x[i], y = truss.node_y[i], z = truss.node_z[i];
        const double inverse_mass =
            constant + (x * (xx * x + xy * y + xz * z) + y * (yy * y + yz * z) + zz * z * z);
        sum[i] = (force[i] > 0.0 ? truss.k_unloading[i] : 0.0) * inverse_mass;
    }
    return lane_sum(sum);
}

// Sum of k_unloading times inverse effective mass over the nodes that push (1/s^2).
double contact_stiffness(const FlatContact& surface, const TrussMesh& mesh, std::size_t b,
                         const TrussBlockState& now, double pushing) {
    const InverseMass& inverse_mass = surface.inverse_mass;
    const Mat3& q = inverse_mass.form;
    if (pushing == mesh.pushable[b])
        return mesh.moments[b].total * inverse_mass.constant + mesh.moments[b].second.cwiseProduct(q).sum();
    return stiffness_of_pushing(mesh.block[b], now.force, inverse_mass.constant, q(0, 0), q(1, 1), q(2, 2),
                                2.0 * q(0, 1), 2.0 * q(0, 2), 2.0 * q(1, 2));
}

double contact_stiffness(const RigidBody& body, const TrussBlock& truss, const TrussBlockState& now,
                         const BlockContact& contact) {
    double sum = 0.0;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(now.force[i] > 0.0)) continue;
        const Vec3 c = Vec3(now.x[i], now.y[i], now.z[i]).cross(contact.normal(i));
        const double share = contact.pressure[i] / now.force[i];
        sum += std::max(1.0, share * share) * truss.k_unloading[i] *
               (body.inverse_mass + c.dot(body.inverse_inertia * c));
    }
    return sum;
}

// Ways and shares of CurvedPress. Where normals part sharply, at an edge, the one before says nothing of the path.
struct alignas(64) Ways {
    Lanes hx, hy, hz, sx, sy, sz;
};

BIRM3D_LANE_LOOP void find_ways(const NodeFaces& faces, const BlockContact& contact, const TrussBlock& truss,
                                const TrussBlockState& before, Ways& ways) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double nx = contact.nx[i], ny = contact.ny[i], nz = contact.nz[i];
        const double cosine = nx * faces.bx[i] + ny * faces.by[i] + nz * faces.bz[i];
        const bool pushes = before.force[i] > 0.0;
        const bool follow = pushes && cosine > sharp_turn;
        const double gap = pushes || faces.gap[i] < 0.0 ? faces.gap[i] : 0.0;
        const double held = faces.held[i];

        // The way at the instant before, w0.
        const double mx = follow ? faces.bx[i] : nx, my = follow ? faces.by[i] : ny,
                     mz = follow ? faces.bz[i] : nz;
        const double x0 = truss.anchor_x[i] - before.x[i], y0 = truss.anchor_y[i] - before.y[i],
                     z0 = truss.anchor_z[i] - before.z[i];
        const double size0 = std::sqrt(x0 * x0 + y0 * y0 + z0 * z0);
        const double per0 = size0 > tolerance::truss_length ? 1.0 / size0 : 0.0;
        const double c0 = (x0 * mx + y0 * my + z0 * mz) * per0, aligned0 = c0 > 0.0 ? c0 : 0.0;
        // Share of the way that goes along the truss, over its cosine.
        const double line0 = in_line(held, aligned0), free0 = 1.0 - line0 * aligned0, along0 = line0 * per0;
        const double w0x = free0 * mx + along0 * x0, w0y = free0 * my + along0 * y0,
                     w0z = free0 * mz + along0 * z0;

        // And now, w1, where w0 would take the node.
        const double onto = w0x * nx + w0y * ny + w0z * nz;
        const double step = gap / (onto > sharp_turn ? onto : 1.0);
        const double x1 = x0 + step * w0x, y1 = y0 + step * w0y, z1 = z0 + step * w0z;
        const double size1 = std::sqrt(x1 * x1 + y1 * y1 + z1 * z1);
        const double per1 = size1 > tolerance::truss_length ? 1.0 / size1 : 0.0;
        const double c1 = (x1 * nx + y1 * ny + z1 * nz) * per1, aligned1 = c1 > 0.0 ? c1 : 0.0;
        const double line1 = in_line(held, aligned1), free1 = 1.0 - line1 * aligned1, along1 = line1 * per1;
        const double w1x = free1 * nx + along1 * x1, w1y = free1 * ny + along1 * y1,
                     w1z = free1 * nz + along1 * z1;

        // Between them, second order; h . n = 1.
        const double mean = 1.0 / (1.0 + (onto > sharp_turn ? onto : 1.0));
        const bool both = onto > sharp_turn;
        const bool own = faces.own_way[i] > 0.0;
        ways.hx[i] = own ? nx : both ? mean * (w0x + w1x) : w1x;
        ways.hy[i] = own ? ny : both ? mean * (w0y + w1y) : w1y;
        ways.hz[i] = own ? nz : both ? mean * (w0z + w1z) : w1z;
        ways.sx[i] = own ? nx : w1x;
        ways.sy[i] = own ? ny : w1y;
        ways.sz[i] = own ? nz : w1z;
    }
}

BIRM3D_LANE_LOOP double greatest_slack(const Lanes& force, const Lanes& deflection, const Lanes& residual) {
    alignas(64) Lanes slack;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        slack[i] = force[i] > 0.0 ? 0.0 : residual[i] - deflection[i];
    for (std::size_t half = lanes / 2; half > 0; half /= 2) {
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < half; ++i)
            slack[i] = slack[half + i] > slack[i] ? slack[half + i] : slack[i];
    }
    return slack[0];
}

void finish(const TrussMesh& mesh, std::size_t b, double nodes, const TrussBlockState& before,
            const Lanes& gap, const BlockContact& contact, TrussBlockState& now, CrushSums& sums) {
    if (nodes >= left) sums.released_work += release(mesh.block[b], before, gap, contact, now);
    now.touching = std::fmod(nodes, left) > 0.0;
    now.drawn = now.leading = 0;
    now.slack = greatest_slack(now.force, now.deflection, now.residual) > tolerance::touching_gap;
    now.box = now.touching
                  ? before.box  // the block is looked at in any case while it touches
                  : Box::around(lanes, [&now](std::size_t i) { return Vec3(now.x[i], now.y[i], now.z[i]); });
}

}  // namespace

InverseMass::InverseMass(const RigidBody& body, const Vec3& n) : constant(body.inverse_mass) {
    Mat3 cross;
    cross << 0.0, n.z(), -n.y(), -n.z(), 0.0, n.x(), n.y(), -n.x(), 0.0;
    form = cross.transpose() * body.inverse_inertia * cross;
}

void crush(const FlatContact& surface, const TrussMesh& mesh, std::size_t b, const Lanes* factor,
           const TrussBlockState& before, TrussBlockState& now, BlockContact& contact, CrushSums& sums) {
    alignas(64) Lanes gap;
    const Vec3& n = surface.face.normal;
    const Vec3 h = holding_direction(n, surface.normal_before);
    const double nodes = press_rows.flat(columns_of(mesh, b, factor),
                                         {n.x(), n.y(), n.z(), surface.face.offset, h.x(), h.y(), h.z()},
                                         columns_of<const double>(before), columns_of<double>(now),
                                         gap.data(), contact.pressure.data(), sums.nodes);
    finish(mesh, b, nodes, before, gap, contact, now, sums);
    if (now.touching) sums.stiffness += contact_stiffness(surface, mesh, b, now, std::fmod(nodes, left));
}

void crush(const NodeFaces& faces, const RigidBody& body, const TrussMesh& mesh, std::size_t b,
           const Lanes* factor, const TrussBlockState& before, TrussBlockState& now, BlockContact& contact,
           CrushSums& sums) {
    alignas(64) Ways ways;
    find_ways(faces, contact, mesh.block[b], before, ways);
    alignas(64) Lanes gap;
    const double nodes = press_rows.curved(
        columns_of(mesh, b, factor),
        {faces.gap.data(), contact.nx.data(), contact.ny.data(), contact.nz.data(), ways.hx.data(),
         ways.hy.data(), ways.hz.data(), ways.sx.data(), ways.sy.data(), ways.sz.data()},
        columns_of<const double>(before), columns_of<double>(now), gap.data(), contact.pressure.data(),
        sums.nodes);
    finish(mesh, b, nodes, before, gap, contact, now, sums);
    if (now.touching) sums.stiffness += contact_stiffness(body, mesh.block[b], now, contact);
}

Wrench total_wrench(const FlatContact& surface, const CrushSums& sums) {
    const NodeSums& nodes = sums.nodes;
    const Vec3 moment(row_sum(nodes.moment_x), row_sum(nodes.moment_y), row_sum(nodes.moment_z));
    return {row_sum(nodes.force) * surface.face.normal, moment.cross(surface.face.normal)};
}

Wrench total_wrench(const CrushSums& sums) {
    const NodeSums& nodes = sums.nodes;
    return {Vec3(row_sum(nodes.push_x), row_sum(nodes.push_y), row_sum(nodes.push_z)),
            Vec3(row_sum(nodes.moment_x), row_sum(nodes.moment_y), row_sum(nodes.moment_z))};
}

Wrench along_trusses(const TrussBlock& truss, const TrussBlockState& now, const BlockContact& contact) {
    Wrench sum;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(now.force[i] > 0.0)) continue;
        const Vec3 node(now.x[i], now.y[i], now.z[i]);
        const Vec3 b = node - Vec3(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
        const double length = b.norm();
        const Vec3 force =
            now.force[i] * (length > tolerance::truss_length ? Vec3(-b / length) : contact.normal(i));
        sum += {force, node.cross(force)};
    }
    return sum;
}

void set_rate_factor(double rate_sensitivity, const TrussBlockState& now, const Twist& motion,
                     const BlockContact& contact, Lanes& factor) {
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(contact.pressure[i] > 0.0)) {
            factor[i] = 1.0;
            continue;
        }
        const Vec3 node(now.x[i], now.y[i], now.z[i]);
        // The truss shortens by the approach along n times -b . h, which is what pressure and truss force differ by.
        const double approach = -contact.normal(i).dot(motion.velocity + motion.angular_velocity.cross(node));
        const double rate = rate_sensitivity * std::max(0.0, approach * contact.pressure[i] / now.force[i]);
        factor[i] = 1.0 + rate * rate;
    }
}

}  // namespace birm3d
