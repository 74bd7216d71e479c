#include "birm3d/kernels/crush.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "kernels/crush_rows.hpp"

namespace birm3d {

namespace {

PressColumns columns_of(const TrussMesh& mesh, std::size_t b) {
    const TrussBlock& truss = mesh.block[b];
    return {truss.anchor_x.data(),
            truss.anchor_y.data(),
            truss.anchor_z.data(),
            truss.length.data(),
            truss.k_unloading.data(),
            truss.compliance.data(),
            mesh.hinge[b * mesh.hinges].deflection.data(),
            mesh.hinges};
}

template <class Number, class State>
PressState<Number> columns_of(State& state) {
    return {state.x.data(),          state.y.data(),     state.z.data(),
            state.deflection.data(), state.force.data(), state.peak_deflection.data(),
            state.peak_force.data()};
}

// Held nodes move along n + m, m the normal of the step before, so that a path is followed to second order
// while the body turns.
FlatSurface surface_of(const HalfSpace& face, const Vec3& before) {
    const Vec3& n = face.normal;
    const Vec3 h = (n + before) / (1.0 + n.dot(before));
    return {n.x(), n.y(), n.z(), face.offset, h.x(), h.y(), h.z()};
}

// A node that follows a receding surface stops where its truss reaches zero force. Few nodes a step do.
// Returns what that takes from the work on the trusses (J).
double release(const TrussBlock& truss, const TrussBlockState& before, const Lanes& gap,
               TrussBlockState& now) {
    double spared = 0.0;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(gap[i] > 0.0 && before.force[i] > 0.0 && now.force[i] == 0.0)) continue;
        const double d0 = before.deflection[i], d1 = now.deflection[i];
        const double residual = before.peak_deflection[i] - before.peak_force[i] * truss.compliance[i];
        const double way = d0 - d1;
        const double share = way > 0.0 ? std::clamp((d0 - residual) / way, 0.0, 1.0) : 0.0;
        const Vec3 anchor(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
        const Vec3 from(before.x[i], before.y[i], before.z[i]), to(now.x[i], now.y[i], now.z[i]);
        const Vec3 b = from + share * (to - from) - anchor;
        // On the way, and as far from its anchor as its residual deflection says.
        now.deflection[i] = d0 - share * way;
        const double length = truss.length[i] - now.deflection[i];
        const Vec3 place = anchor + (length > tolerance::truss_length ? length / b.norm() : 1.0) * b;
        now.x[i] = place.x(), now.y[i] = place.y(), now.z[i] = place.z();
        spared += 0.5 * before.force[i] * (now.deflection[i] - d1);
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
double contact_stiffness(const InverseMass& inverse_mass, const TrussMesh& mesh, std::size_t b,
                         const Lanes& force, double pushing) {
    const Mat3& q = inverse_mass.form;
    if (pushing == mesh.pushable[b])
        return mesh.moments[b].total * inverse_mass.constant + mesh.moments[b].second.cwiseProduct(q).sum();
    return stiffness_of_pushing(mesh.block[b], force, inverse_mass.constant, q(0, 0), q(1, 1), q(2, 2),
                                2.0 * q(0, 1), 2.0 * q(0, 2), 2.0 * q(1, 2));
}

}  // namespace

InverseMass::InverseMass(const RigidBody& body, const Vec3& n) : constant(body.inverse_mass) {
    Mat3 cross;
    cross << 0.0, n.z(), -n.y(), -n.z(), 0.0, n.x(), n.y(), -n.x(), 0.0;
    form = cross.transpose() * body.inverse_inertia * cross;
}

Wrench along_trusses(const TrussBlock& truss, const TrussBlockState& now, const Vec3& normal) {
    Wrench sum;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(now.force[i] > 0.0)) continue;
        const Vec3 node(now.x[i], now.y[i], now.z[i]);
        const Vec3 b = node - Vec3(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
        const double length = b.norm();
        const Vec3 force = now.force[i] * (length > tolerance::truss_length ? Vec3(-b / length) : normal);
        sum += {force, node.cross(force)};
    }
    return sum;
}

void crush(const InverseMass& inverse_mass, const TrussMesh& mesh, std::size_t b, const HalfSpace& face,
           const TrussBlockState& before, TrussBlockState& now, BlockContact& contact, CrushSums& sums) {
    const TrussBlock& truss = mesh.block[b];
    now.normal = contact.normal = face.normal;
    alignas(64) Lanes gap;
    const double nodes =
        press_flat(columns_of(mesh, b), surface_of(face, before.normal), columns_of<const double>(before),
                   columns_of<double>(now), gap.data(), contact.pressure.data(), sums.nodes);
    if (nodes >= left) sums.released_work += release(truss, before, gap, now);
    const double pushing = std::fmod(nodes, left);
    now.touching = pushing > 0.0;
    if (now.touching) {
        sums.stiffness += contact_stiffness(inverse_mass, mesh, b, now.force, pushing);
        now.box = before.box;  // the block is looked at in any case while it touches
    } else {
        now.box = Box::around(lanes, [&now](std::size_t i) { return Vec3(now.x[i], now.y[i], now.z[i]); });
    }
}

SkinForces total(const CrushSums& sums, const Vec3& normal) {
    const NodeSums& nodes = sums.nodes;
    SkinForces skin;
    skin.normal_force = row_sum(nodes.force);
    const Vec3 moment(row_sum(nodes.force_x), row_sum(nodes.force_y), row_sum(nodes.force_z));
    skin.contact = {skin.normal_force * normal, moment.cross(normal)};
    skin.work = 0.5 * row_sum(nodes.twice_work) + sums.released_work;
    skin.stored = 0.5 * row_sum(nodes.twice_stored);
    skin.stiffness = sums.stiffness;
    return skin;
}

}  // namespace birm3d
