#include "kernels/crush.hpp"

#include <algorithm>
#include <cmath>

#include "base/block_loop.hpp"
#include "birm3d/base/tolerances.hpp"
#include "kernels/crush_columns.hpp"
#include "kernels/simd_table.hpp"

namespace birm3d {

namespace {

// Slope of unloading of each truss where it pushes (N/m). That of a line is its coefficient, which
// n F / u would give only up to rounding.
BIRM3D_BLOCK_LOOP void find_tangents(const TrussBlock& truss, const TrussBlockState& now,
                                     BlockColumn& tangent) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double left = std::max(now.deflection[i] - now.residual[i], tolerance::truss_length);
        const double curve = unloading_tangent<double>(recovery_degree, now.force[i], left);
        tangent[i] = has_recovery(truss.recovery[i]) ? curve : now.unloading[i];
    }
}

BIRM3D_BLOCK_LOOP double stiffness_of_pushing(const TrussBlock& truss, const BlockColumn& slope,
                                              const BlockColumn& force, double constant, double xx, double yy,
                                              double zz, double xy, double xz, double yz) {
    alignas(64) BlockColumn sum;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double x = truss.node_x[i], y = truss.node_y[i], z = truss.node_z[i];
        const double inverse_mass =
            constant + (x * (xx * x + xy * y + xz * z) + y * (yy * y + yz * z) + zz * z * z);
        sum[i] = (force[i] > 0.0 ? slope[i] : 0.0) * inverse_mass;
    }
    return block_sum(sum);
}

// Sum of the slopes of unloading times inverse effective mass over the nodes that push (1/s^2).
double contact_stiffness(const FlatContact& surface, const TrussMesh& mesh, std::size_t b,
                         const TrussBlockState& now, double pushing) {
    const InverseMass& inverse_mass = surface.inverse_mass;
    const Mat3& q = inverse_mass.form;
    if (pushing == mesh.pushable[b] && !mesh.recovers)
        return mesh.moments[b].total * inverse_mass.constant + mesh.moments[b].second.cwiseProduct(q).sum();
    alignas(64) BlockColumn tangent;
    if (mesh.recovers) find_tangents(mesh.block[b], now, tangent);
    return stiffness_of_pushing(mesh.block[b], mesh.recovers ? tangent : now.unloading, now.force,
                                inverse_mass.constant, q(0, 0), q(1, 1), q(2, 2), 2.0 * q(0, 1),
                                2.0 * q(0, 2), 2.0 * q(1, 2));
}

BIRM3D_BLOCK_LOOP double greatest_slack(const BlockColumn& force, const BlockColumn& deflection,
                                        const BlockColumn& residual) {
    alignas(64) BlockColumn slack;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        slack[i] = force[i] > 0.0 ? 0.0 : residual[i] - deflection[i];
    return block_max(slack);
}

void set_flags(const PressedNodes& nodes, TrussBlockState& now) {
    now.touching = nodes.pushing > 0.0;
    now.slack = nodes.pushing < static_cast<double>(block_size) &&
                greatest_slack(now.force, now.deflection, now.residual) > tolerance::touching_gap;
}

}  // namespace

CrushSums& CrushSums::operator-=(const CrushSums& part) {
    const auto take = [](double* from, const double* what) {
        for (std::size_t i = 0; i < 8; ++i)
            from[i] -= what[i];
    };
    NodeSums& a = nodes;
    const NodeSums& b = part.nodes;
    take(a.force, b.force);
    take(a.moment_x, b.moment_x), take(a.moment_y, b.moment_y), take(a.moment_z, b.moment_z);
    take(a.push_x, b.push_x), take(a.push_y, b.push_y), take(a.push_z, b.push_z);
    take(a.stiffness, b.stiffness);
    take(a.twice_work, b.twice_work), take(a.twice_stored, b.twice_stored);
    released_work -= part.released_work;
    flat_stiffness -= part.flat_stiffness;
    return *this;
}

InverseMass::InverseMass(const RigidBody& body, const Vec3& n) : constant(body.inverse_mass) {
    Mat3 cross;
    cross << 0.0, n.z(), -n.y(), -n.z(), 0.0, n.x(), n.y(), -n.x(), 0.0;
    form = cross.transpose() * body.inverse_inertia * cross;
}

FlatContact::FlatContact(const RigidBody& body, const HalfSpace& face_, const HalfSpace& face_before)
    : face(face_),
      holding((face.normal + face_before.normal) / (1.0 + face.normal.dot(face_before.normal))),
      inverse_mass(body, face.normal) {}

bool crush(const FlatContact& surface, const TrussMesh& mesh, std::size_t b, const BlockColumn* factor,
           const TrussBlockState& before, TrussBlockState& now, BlockContact& contact, CrushSums& sums) {
    alignas(64) BlockColumn gap;
    const Vec3& n = surface.face.normal;
    const Vec3& h = surface.holding;
    const PressedNodes nodes = simd.press_flat(
        columns_of(mesh, b, factor), {n.x(), n.y(), n.z(), surface.face.offset, h.x(), h.y(), h.z()},
        columns_of<const double>(before), columns_of<double>(now), gap.data(), contact.normal_force.data(),
        sums.nodes);
    set_flags(nodes, now);
    if (now.touching) sums.flat_stiffness += contact_stiffness(surface, mesh, b, now, nodes.pushing);
    return nodes.ceased;
}

bool crush(const NodeFaces& faces, const RigidBody& body, const TrussMesh& mesh, std::size_t b,
           const BlockColumn* factor, const TrussBlockState& before, TrussBlockState& now,
           BlockContact& contact, CrushSums& sums) {
    const Mat3& q = body.inverse_inertia;
    alignas(64) BlockColumn gap;
    const PressedNodes nodes =
        simd.press_curved(columns_of(mesh, b, factor),
                          {faces.gap.data(),  contact.nx.data(), contact.ny.data(), contact.nz.data(),
                           faces.bx.data(),   faces.by.data(),   faces.bz.data(),   faces.per_force.data(),
                           contact.px.data(), contact.py.data(), contact.pz.data(), contact.tx.data(),
                           contact.ty.data(), contact.tz.data(), body.inverse_mass, q(0, 0),
                           q(1, 1),           q(2, 2),           2.0 * q(0, 1),     2.0 * q(0, 2),
                           2.0 * q(1, 2)},
                          columns_of<const double>(before), columns_of<double>(now), gap.data(),
                          contact.normal_force.data(), sums.nodes);
    set_flags(nodes, now);
    return nodes.ceased;
}

Wrench total_wrench(const FlatContact& surface, const CrushSums& sums) {
    const NodeSums& nodes = sums.nodes;
    const Vec3 moment(packet_sum(nodes.moment_x), packet_sum(nodes.moment_y), packet_sum(nodes.moment_z));
    return {packet_sum(nodes.force) * surface.face.normal, moment.cross(surface.face.normal)};
}

Wrench total_wrench(const CrushSums& sums) {
    const NodeSums& nodes = sums.nodes;
    return {Vec3(packet_sum(nodes.push_x), packet_sum(nodes.push_y), packet_sum(nodes.push_z)),
            Vec3(packet_sum(nodes.moment_x), packet_sum(nodes.moment_y), packet_sum(nodes.moment_z))};
}

Wrench along_trusses(const TrussBlock& truss, const TrussBlockState& now, const BlockContact& contact) {
    Wrench sum;
    for (std::size_t i = 0; i < block_size; ++i) {
        if (!(now.force[i] > 0.0)) continue;
        const Vec3 node(now.x[i], now.y[i], now.z[i]);
        const Vec3 b = node - anchor_of(truss, i);
        const double length = b.norm();
        const Vec3 force =
            now.force[i] * (length > tolerance::truss_length ? Vec3(-b / length) : contact.normal(i));
        sum += {force, node.cross(force)};
    }
    return sum;
}

void set_rate_factor(double rate_sensitivity, const BlockColumn& force, const Twist& motion,
                     const Places& places, const BlockContact& contact, BlockColumn& factor) {
    for (std::size_t i = 0; i < block_size; ++i) {
        if (!(contact.normal_force[i] > 0.0)) {
            factor[i] = 1.0;
            continue;
        }
        // The truss shortens by -b . h times the approach along n. The normal force is the truss force times the same
        // factor.
        const double approach =
            -contact.normal(i).dot(motion.velocity + motion.angular_velocity.cross(places[i]));
        const double rate = rate_sensitivity * std::max(0.0, approach * contact.normal_force[i] / force[i]);
        factor[i] = 1.0 + rate * rate;
    }
}

}  // namespace birm3d
