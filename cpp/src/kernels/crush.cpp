#include "birm3d/kernels/crush.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// |B| and -B . n of each truss with its node on the surface (m).
struct alignas(64) Geometry {
    Lanes length, facing;
};

// Adds one hinge of each truss to the loading envelope (Fig. 3), N.
BIRM3D_LANE_LOOP void add_hinge(const Hinge& hinge, const Lanes& deflection, Lanes& force) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double beyond = deflection[i] - hinge.deflection[i];
        force[i] += hinge.slope_change[i] * (beyond > 0.0 ? beyond : 0.0);
    }
}

// 1. Moves the nodes that are at the surface onto it, and finds the deflection of their trusses.
BIRM3D_LANE_LOOP void hold_on_surface(const TrussBlock& truss, const TrussBlockState& before,
                                      const BlockContact& contact, TrussBlockState& now, Geometry& geometry) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double nx = contact.normal_x[i], ny = contact.normal_y[i], nz = contact.normal_z[i];
        const double was = before.pushing[i];  // 0 or 1: a node that arrives has no earlier normal
        const double dx = nx + was * before.normal_x[i], dy = ny + was * before.normal_y[i],
                     dz = nz + was * before.normal_z[i];
        const double held = contact.gap[i] < 0.0 ? 1.0 : was;
        const double shift = held * contact.gap[i] / (dx * nx + dy * ny + dz * nz);
        const double x = before.x[i] - shift * dx, y = before.y[i] - shift * dy, z = before.z[i] - shift * dz;
        const double bx = x - truss.anchor_x[i], by = y - truss.anchor_y[i], bz = z - truss.anchor_z[i];
        const double length = std::sqrt(bx * bx + by * by + bz * bz);
        now.x[i] = x;
        now.y[i] = y;
        now.z[i] = z;
        now.normal_x[i] = nx;
        now.normal_y[i] = ny;
        now.normal_z[i] = nz;
        now.deflection[i] = truss.length[i] - length;
        geometry.length[i] = length;
        geometry.facing[i] = -(bx * nx + by * ny + bz * nz);
    }
}

// 2. Truss forces by the law of Fig. 3; `law` comes in as the force on the loading envelope. Returns how
// many nodes left the surface because their truss no longer presses.
BIRM3D_LANE_LOOP double press_trusses(const TrussBlock& truss, const Lanes& law,
                                      const TrussBlockState& before, BlockContact& contact,
                                      TrussBlockState& now) {
    Lanes left;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double gap = contact.gap[i], was = before.pushing[i], on_envelope = law[i];
        const double d0 = before.deflection[i], d1 = now.deflection[i], dp = before.peak_deflection[i],
                     Fp = before.peak_force[i];
        const double held = gap < 0.0 ? 1.0 : was;
        const double line = Fp - truss.k_unloading[i] * (dp - d1);
        const double on_line = line > 0.0 ? line : 0.0;
        const double F = held * (d1 > dp ? on_envelope : on_line);
        const double d = held > 0.0 ? d1 : d0;
        const double further = d1 > dp ? held : 0.0;
        now.force[i] = F;
        now.pushing[i] = F > 0.0 ? 1.0 : 0.0;
        now.deflection[i] = d;
        now.peak_deflection[i] = dp + further * (d1 - dp);
        now.peak_force[i] = Fp + further * (on_envelope - Fp);
        contact.work[i] = 0.5 * (before.force[i] + F) * (d - d0);
        contact.stored[i] = 0.5 * F * F * truss.compliance[i];
        left[i] = (gap > 0.0 ? was : 0.0) * (F > 0.0 ? 0.0 : 1.0);
    }
    return lane_sum(left);
}

// A node that follows a receding surface stops where its truss reaches zero force. Few nodes a step do.
void release(const TrussBlock& truss, const TrussBlockState& before, BlockContact& contact,
             TrussBlockState& now) {
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(contact.gap[i] > 0.0 && before.pushing[i] > 0.0 && now.force[i] == 0.0)) continue;
        const double d0 = before.deflection[i];
        const double residual = before.peak_deflection[i] - before.peak_force[i] * truss.compliance[i];
        const double way = d0 - now.deflection[i];
        const double share = way > 0.0 ? std::clamp((d0 - residual) / way, 0.0, 1.0) : 0.0;
        now.x[i] = before.x[i] + share * (now.x[i] - before.x[i]);
        now.y[i] = before.y[i] + share * (now.y[i] - before.y[i]);
        now.z[i] = before.z[i] + share * (now.z[i] - before.z[i]);
        now.deflection[i] = d0 - share * way;
        contact.work[i] = 0.5 * before.force[i] * (now.deflection[i] - d0);
    }
}

// Sums over the block, and the bounds that the step control and the broad phase need.
struct Load {
    double force_x, force_y, force_z, torque_x, torque_y, torque_z, normal_force, work, stored;
    double stiffness;       // see SkinForces (1/s^2)
    double largest_square;  // of the distance from the ball's centre (m^2)
};

// Inverse mass and inertia as plain numbers, for the loop.
struct Inverse {
    explicit Inverse(const RigidBody& body)
        : mass(body.inverse_mass),
          xx(body.inverse_inertia(0, 0)),
          yy(body.inverse_inertia(1, 1)),
          zz(body.inverse_inertia(2, 2)),
          xy(2.0 * body.inverse_inertia(0, 1)),
          xz(2.0 * body.inverse_inertia(0, 2)),
          yz(2.0 * body.inverse_inertia(1, 2)) {}
    double mass, xx, yy, zz, xy, xz, yz;
};

// 3. Forces on the vehicle. along_truss is 0 or 1; center is that of the block's ball.
BIRM3D_LANE_LOOP Load load_vehicle(const TrussBlock& truss, const Geometry& geometry, double along_truss,
                                   const Inverse& inverse, const std::array<double, 3>& center,
                                   const TrussBlockState& now, BlockContact& contact) {
    const double along_normal = 1.0 - along_truss;
    const double center_x = center[0], center_y = center[1], center_z = center[2];
    const Inverse W = inverse;
    alignas(64) Lanes force_x, force_y, force_z, torque_x, torque_y, torque_z, stiffness, square;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = now.x[i], y = now.y[i], z = now.z[i];
        const double size = geometry.length[i], facing = geometry.facing[i];
        // A closed truss has no direction of its own any more: it presses along the normal.
        const double open = size > tolerance::truss_length ? 1.0 : 0.0;
        const double scale = now.force[i] * open / (size > tolerance::truss_length ? size : 1.0);
        const double pressure = scale * (facing > 0.0 ? facing : 0.0) + now.force[i] * (1.0 - open);
        const double by_normal = along_normal * pressure, by_truss = along_truss * scale;
        const double fx = by_normal * contact.normal_x[i] - by_truss * (x - truss.anchor_x[i]);
        const double fy = by_normal * contact.normal_y[i] - by_truss * (y - truss.anchor_y[i]);
        const double fz = by_normal * contact.normal_z[i] - by_truss * (z - truss.anchor_z[i]);
        contact.pressure[i] = pressure;
        force_x[i] = fx;
        force_y[i] = fy;
        force_z[i] = fz;
        torque_x[i] = y * fz - z * fy;
        torque_y[i] = z * fx - x * fz;
        torque_z[i] = x * fy - y * fx;
        // Inverse effective mass of the node along n (the denominator of Eq. 1): 1/m + c . I^-1 c, c = r x n.
        const double nx = contact.normal_x[i], ny = contact.normal_y[i], nz = contact.normal_z[i];
        const double cx = y * nz - z * ny, cy = z * nx - x * nz, cz = x * ny - y * nx;
        const double turning =
            cx * (W.xx * cx + W.xy * cy + W.xz * cz) + cy * (W.yy * cy + W.yz * cz) + W.zz * cz * cz;
        stiffness[i] = now.pushing[i] * truss.k_unloading[i] * (W.mass + turning);
        const double dx = x - center_x, dy = y - center_y, dz = z - center_z;
        square[i] = dx * dx + dy * dy + dz * dz;
    }
    return {lane_sum(force_x),          lane_sum(force_y),      lane_sum(force_z),
            lane_sum(torque_x),         lane_sum(torque_y),     lane_sum(torque_z),
            lane_sum(contact.pressure), lane_sum(contact.work), lane_sum(contact.stored),
            lane_sum(stiffness),        lane_max(square)};
}

}  // namespace

SkinForces crush(const RigidBody& body, const TrussMesh& mesh, ContactModel model, std::size_t b,
                 const TrussBlockState& before, TrussBlockState& now, BlockContact& contact) {
    const TrussBlock& truss = mesh.block[b];
    const Vec3& center = mesh.node_ball[b].center;
    Geometry geometry;
    hold_on_surface(truss, before, contact, now, geometry);
    alignas(64) Lanes law{};
    for (std::size_t j = 0; j < mesh.hinges; ++j)
        add_hinge(mesh.hinge[b * mesh.hinges + j], now.deflection, law);
    if (press_trusses(truss, law, before, contact, now) > 0.0) release(truss, before, contact, now);
    const double along_truss = model == ContactModel::along_truss ? 1.0 : 0.0;
    const Load load = load_vehicle(truss, geometry, along_truss, Inverse(body),
                                   {center.x(), center.y(), center.z()}, now, contact);
    now.touching = load.stiffness > 0.0;
    now.ball_radius = std::max(before.ball_radius, std::sqrt(load.largest_square));

    SkinForces sum;
    sum.contact = {Vec3(load.force_x, load.force_y, load.force_z),
                   Vec3(load.torque_x, load.torque_y, load.torque_z)};
    sum.normal_force = load.normal_force;
    sum.work = load.work;
    sum.stored = load.stored;
    sum.stiffness = load.stiffness;
    return sum;
}

}  // namespace birm3d
