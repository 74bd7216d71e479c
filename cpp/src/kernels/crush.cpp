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

// Which way held nodes move: along n where they arrive, along n + m where they were held already, m the
// normal of the step before; `share` is 1 / ((n + m) . n).
struct Slide {
    Slide(const Vec3& normal, const Vec3& before)
        : nx(normal.x()),
          ny(normal.y()),
          nz(normal.z()),
          mx(before.x()),
          my(before.y()),
          mz(before.z()),
          share(1.0 / (1.0 + normal.dot(before))) {}
    double nx, ny, nz, mx, my, mz, share;
};

// 1. Moves the nodes that are at the surface onto it, and finds the deflection of their trusses.
BIRM3D_LANE_LOOP void hold_on_surface(const TrussBlock& truss, const TrussBlockState& before,
                                      const Slide& slide, const Lanes& gap, TrussBlockState& now,
                                      Geometry& geometry) {
    const Slide s = slide;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double was = before.force[i] > 0.0 ? 1.0 : 0.0;
        const double held = gap[i] < 0.0 ? 1.0 : was;
        const double shift = held * gap[i] * (before.force[i] > 0.0 ? s.share : 1.0);
        const double x = before.x[i] - shift * (s.nx + was * s.mx);
        const double y = before.y[i] - shift * (s.ny + was * s.my);
        const double z = before.z[i] - shift * (s.nz + was * s.mz);
        const double bx = x - truss.anchor_x[i], by = y - truss.anchor_y[i], bz = z - truss.anchor_z[i];
        const double length = std::sqrt(bx * bx + by * by + bz * bz);
        now.x[i] = x;
        now.y[i] = y;
        now.z[i] = z;
        now.deflection[i] = truss.length[i] - length;
        geometry.length[i] = length;
        geometry.facing[i] = -(bx * s.nx + by * s.ny + bz * s.nz);
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
        const double gap = contact.gap[i], was = before.force[i] > 0.0 ? 1.0 : 0.0, on_envelope = law[i];
        const double d0 = before.deflection[i], d1 = now.deflection[i], dp = before.peak_deflection[i],
                     Fp = before.peak_force[i];
        const double held = gap < 0.0 ? 1.0 : was;
        const double line = Fp - truss.k_unloading[i] * (dp - d1);
        const double on_line = line > 0.0 ? line : 0.0;
        const double F = held * (d1 > dp ? on_envelope : on_line);
        const double d = held > 0.0 ? d1 : d0;
        const double further = d1 > dp ? held : 0.0;
        now.force[i] = F;
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
        if (!(contact.gap[i] > 0.0 && before.force[i] > 0.0 && now.force[i] == 0.0)) continue;
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
    double stiffness;  // see SkinForces (1/s^2)
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

// 3. Forces on the vehicle, along the normal (projected) or along each truss.
template <bool along_truss>
BIRM3D_IN_LANE_LOOP Load sum_load(const TrussBlock& truss, const Geometry& geometry, const Inverse& W,
                                  double nx, double ny, double nz, const TrussBlockState& now,
                                  BlockContact& contact) {
    alignas(64) Lanes force_x, force_y, force_z, torque_x, torque_y, torque_z, stiffness;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = now.x[i], y = now.y[i], z = now.z[i], force = now.force[i];
        const double size = geometry.length[i], facing = geometry.facing[i];
        // A closed truss has no direction of its own any more: it presses along the normal.
        const double open = size > tolerance::truss_length ? 1.0 : 0.0;
        const double scale = force * open / (size > tolerance::truss_length ? size : 1.0);
        const double pressure = scale * (facing > 0.0 ? facing : 0.0) + force * (1.0 - open);
        contact.pressure[i] = pressure;
        // Arm of the node about the normal through the mass centre.
        const double cx = y * nz - z * ny, cy = z * nx - x * nz, cz = x * ny - y * nx;
        if constexpr (along_truss) {
            const double fx = -scale * (x - truss.anchor_x[i]), fy = -scale * (y - truss.anchor_y[i]),
                         fz = -scale * (z - truss.anchor_z[i]);
            force_x[i] = fx;
            force_y[i] = fy;
            force_z[i] = fz;
            torque_x[i] = y * fz - z * fy;
            torque_y[i] = z * fx - x * fz;
            torque_z[i] = x * fy - y * fx;
        } else {
            torque_x[i] = pressure * cx;
            torque_y[i] = pressure * cy;
            torque_z[i] = pressure * cz;
        }
        // Inverse effective mass of the node along n (the denominator of Eq. 1): 1/m + c . I^-1 c, c = r x n.
        const double turning =
            cx * (W.xx * cx + W.xy * cy + W.xz * cz) + cy * (W.yy * cy + W.yz * cz) + W.zz * cz * cz;
        stiffness[i] = (force > 0.0 ? truss.k_unloading[i] : 0.0) * (W.mass + turning);
    }
    Load load{};
    load.normal_force = lane_sum(contact.pressure);
    if constexpr (along_truss) {
        load.force_x = lane_sum(force_x), load.force_y = lane_sum(force_y), load.force_z = lane_sum(force_z);
    } else {
        load.force_x = load.normal_force * nx;
        load.force_y = load.normal_force * ny;
        load.force_z = load.normal_force * nz;
    }
    load.torque_x = lane_sum(torque_x), load.torque_y = lane_sum(torque_y),
    load.torque_z = lane_sum(torque_z);
    load.work = lane_sum(contact.work), load.stored = lane_sum(contact.stored);
    load.stiffness = lane_sum(stiffness);
    return load;
}

BIRM3D_LANE_LOOP Load load_projected(const TrussBlock& truss, const Geometry& geometry,
                                     const Inverse& inverse, double nx, double ny, double nz,
                                     const TrussBlockState& now, BlockContact& contact) {
    return sum_load<false>(truss, geometry, inverse, nx, ny, nz, now, contact);
}

BIRM3D_LANE_LOOP Load load_along_truss(const TrussBlock& truss, const Geometry& geometry,
                                       const Inverse& inverse, double nx, double ny, double nz,
                                       const TrussBlockState& now, BlockContact& contact) {
    return sum_load<true>(truss, geometry, inverse, nx, ny, nz, now, contact);
}

// Greatest distance of a node from the centre of the block's ball (m).
double farthest(const TrussBlockState& block, const Vec3& center) {
    double square = 0.0;
    for (std::size_t i = 0; i < lanes; ++i)
        square = std::max(square, (Vec3(block.x[i], block.y[i], block.z[i]) - center).squaredNorm());
    return std::sqrt(square);
}

}  // namespace

SkinForces crush(const RigidBody& body, const TrussMesh& mesh, ContactModel model, std::size_t b,
                 const TrussBlockState& before, TrussBlockState& now, BlockContact& contact) {
    const TrussBlock& truss = mesh.block[b];
    Geometry geometry;
    now.normal = contact.normal;
    hold_on_surface(truss, before, Slide(contact.normal, before.normal), contact.gap, now, geometry);
    alignas(64) Lanes law{};
    for (std::size_t j = 0; j < mesh.hinges; ++j)
        add_hinge(mesh.hinge[b * mesh.hinges + j], now.deflection, law);
    if (press_trusses(truss, law, before, contact, now) > 0.0) release(truss, before, contact, now);
    const auto load_vehicle = model == ContactModel::projected ? load_projected : load_along_truss;
    const Vec3& n = contact.normal;
    const Load load = load_vehicle(truss, geometry, Inverse(body), n.x(), n.y(), n.z(), now, contact);
    now.touching = load.stiffness > 0.0;
    // A block that touches is looked at in any case; its ball matters once it lets go.
    now.ball_radius = now.touching ? before.ball_radius
                                   : std::max(before.ball_radius, farthest(now, mesh.node_ball[b].center));

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
