#include "birm3d/kernels/crush.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "kernels/crush_dispatch.hpp"

namespace birm3d {

namespace {

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
                         const TrussBlockState& now, const BlockContact&, double pushing) {
    const InverseMass& inverse_mass = surface.inverse_mass;
    const Mat3& q = inverse_mass.form;
    if (pushing == mesh.pushable[b])
        return mesh.moments[b].total * inverse_mass.constant + mesh.moments[b].second.cwiseProduct(q).sum();
    return stiffness_of_pushing(mesh.block[b], now.force, inverse_mass.constant, q(0, 0), q(1, 1), q(2, 2),
                                2.0 * q(0, 1), 2.0 * q(0, 2), 2.0 * q(1, 2));
}

double contact_stiffness(const CurvedContact& surface, const TrussMesh& mesh, std::size_t b,
                         const TrussBlockState& now, const BlockContact& contact, double) {
    double sum = 0.0;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(now.force[i] > 0.0)) continue;
        const Vec3 c = Vec3(now.x[i], now.y[i], now.z[i]).cross(contact.normal(i));
        sum += mesh.block[b].k_unloading[i] *
               (surface.body.inverse_mass + c.dot(surface.body.inverse_inertia * c));
    }
    return sum;
}

double press(const FlatContact& surface, const PressColumns& truss, const TrussBlockState& before,
             TrussBlockState& now, Lanes& gap, BlockContact& contact, NodeSums& sums) {
    const Vec3& n = surface.face.normal;
    const Vec3 h = holding_direction(n, surface.normal_before);
    return press_rows.flat(truss, {n.x(), n.y(), n.z(), surface.face.offset, h.x(), h.y(), h.z()},
                           columns_of<const double>(before), columns_of<double>(now), gap.data(),
                           contact.pressure.data(), sums);
}

double press(const CurvedContact& surface, const PressColumns& truss, const TrussBlockState& before,
             TrussBlockState& now, Lanes& gap, BlockContact& contact, NodeSums& sums) {
    alignas(64) Lanes hx, hy, hz;
    for (std::size_t i = 0; i < lanes; ++i) {
        const Vec3 node(before.x[i], before.y[i], before.z[i]);
        const Vec3 n = surface.face.normal_at(node);
        const Vec3 h = holding_direction(n, surface.before.normal_at(node));
        gap[i] = surface.face.gap(node);
        contact.nx[i] = n.x(), contact.ny[i] = n.y(), contact.nz[i] = n.z();
        hx[i] = h.x(), hy[i] = h.y(), hz[i] = h.z();
    }
    return press_rows.curved(truss,
                             {gap.data(), contact.nx.data(), contact.ny.data(), contact.nz.data(), hx.data(),
                              hy.data(), hz.data()},
                             columns_of<const double>(before), columns_of<double>(now), gap.data(),
                             contact.pressure.data(), sums);
}

template <class Contact>
void crush_block(const Contact& surface, const TrussMesh& mesh, std::size_t b, const Lanes* factor,
                 const TrussBlockState& before, TrussBlockState& now, BlockContact& contact,
                 CrushSums& sums) {
    alignas(64) Lanes gap;
    const double nodes = press(surface, columns_of(mesh, b, factor), before, now, gap, contact, sums.nodes);
    if (nodes >= left) sums.released_work += release(mesh.block[b], before, gap, contact, now);
    const double pushing = std::fmod(nodes, left);
    now.touching = pushing > 0.0;
    if (now.touching) {
        sums.stiffness += contact_stiffness(surface, mesh, b, now, contact, pushing);
        now.box = before.box;  // the block is looked at in any case while it touches
    } else {
        now.box = Box::around(lanes, [&now](std::size_t i) { return Vec3(now.x[i], now.y[i], now.z[i]); });
    }
}

SkinForces without_wrench(const CrushSums& sums) {
    SkinForces skin;
    skin.normal_force = row_sum(sums.nodes.force);
    skin.work = 0.5 * row_sum(sums.nodes.twice_work) + sums.released_work;
    skin.stored = 0.5 * row_sum(sums.nodes.twice_stored);
    skin.stiffness = sums.stiffness;
    return skin;
}

}  // namespace

InverseMass::InverseMass(const RigidBody& body, const Vec3& n) : constant(body.inverse_mass) {
    Mat3 cross;
    cross << 0.0, n.z(), -n.y(), -n.z(), 0.0, n.x(), n.y(), -n.x(), 0.0;
    form = cross.transpose() * body.inverse_inertia * cross;
}

void crush(const FlatContact& surface, const TrussMesh& mesh, std::size_t b, const Lanes* factor,
           const TrussBlockState& before, TrussBlockState& now, BlockContact& contact, CrushSums& sums) {
    crush_block(surface, mesh, b, factor, before, now, contact, sums);
}

void crush(const CurvedContact& surface, const TrussMesh& mesh, std::size_t b, const Lanes* factor,
           const TrussBlockState& before, TrussBlockState& now, BlockContact& contact, CrushSums& sums) {
    crush_block(surface, mesh, b, factor, before, now, contact, sums);
}

SkinForces total(const FlatContact& surface, const CrushSums& sums) {
    SkinForces skin = without_wrench(sums);
    const NodeSums& nodes = sums.nodes;
    const Vec3 moment(row_sum(nodes.moment_x), row_sum(nodes.moment_y), row_sum(nodes.moment_z));
    skin.contact = {skin.normal_force * surface.face.normal, moment.cross(surface.face.normal)};
    return skin;
}

SkinForces total(const CurvedContact&, const CrushSums& sums) {
    SkinForces skin = without_wrench(sums);
    const NodeSums& nodes = sums.nodes;
    skin.contact = {Vec3(row_sum(nodes.push_x), row_sum(nodes.push_y), row_sum(nodes.push_z)),
                    Vec3(row_sum(nodes.moment_x), row_sum(nodes.moment_y), row_sum(nodes.moment_z))};
    return skin;
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

Lanes rate_factor(const TrussMesh& mesh, std::size_t b, const TrussBlockState& now, const Twist& motion,
                  const BlockContact& contact) {
    const TrussBlock& truss = mesh.block[b];
    Lanes factor;
    for (std::size_t i = 0; i < lanes; ++i) {
        const Vec3 node(now.x[i], now.y[i], now.z[i]);
        const Vec3 to_anchor = Vec3(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]) - node;
        const Vec3 n = contact.normal(i);
        // The node slides along the surface: the truss shortens by the approach along n times b . n.
        const double approach = -n.dot(motion.velocity + motion.angular_velocity.cross(node));
        const double share = to_anchor.dot(n) / std::max(to_anchor.norm(), tolerance::truss_length);
        const double rate = mesh.rate_sensitivity * std::max(0.0, approach * share);
        factor[i] = 1.0 + rate * rate;
    }
    return factor;
}

}  // namespace birm3d
