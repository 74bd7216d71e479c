#include "birm3d/kernels/friction.hpp"

#include <cmath>

namespace birm3d {

namespace {

// Plain numbers for the loop: mu, the speed of full friction, twist, inverse mass and inertia.
struct Sliding {
    double mu, full_speed;
    double vx, vy, vz, wx, wy, wz;
    double inverse_mass, Wxx, Wyy, Wzz, Wxy, Wxz, Wyz;
};

struct Sum {
    double fx, fy, fz, tx, ty, tz, rate;
};

struct alignas(64) LaneSums {
    Lanes fx, fy, fz, tx, ty, tz, rate;
};

// A node that slides with the velocity u; what is along the normal does not count.
BIRM3D_IN_LANE_LOOP void friction_of_node(const Sliding& s, const Places& at, const BlockContact& contact,
                                          std::size_t i, double ux, double uy, double uz, LaneSums& sums) {
    const double x = at.x[i], y = at.y[i], z = at.z[i];
    const double nx = contact.nx[i], ny = contact.ny[i], nz = contact.nz[i];
    const double un = ux * nx + uy * ny + uz * nz;
    const double sx = ux - un * nx, sy = uy - un * ny, sz = uz - un * nz;
    const double speed = std::sqrt(sx * sx + sy * sy + sz * sz);
    const double per_speed = 1.0 / (speed > s.full_speed ? speed : s.full_speed);
    const double limit = s.mu * contact.pressure[i];
    const double px = -sx * per_speed, py = -sy * per_speed, pz = -sz * per_speed;
    sums.fx[i] = limit * px;
    sums.fy[i] = limit * py;
    sums.fz[i] = limit * pz;
    // c = r x direction; torque = limit * c.
    const double cx = y * pz - z * py, cy = z * px - x * pz, cz = x * py - y * px;
    sums.tx[i] = limit * cx;
    sums.ty[i] = limit * cy;
    sums.tz[i] = limit * cz;
    // Inverse effective mass along the sliding direction (Eq. 1's denominator).
    const double turning =
        cx * (s.Wxx * cx + s.Wxy * cy + s.Wxz * cz) + cy * (s.Wyy * cy + s.Wyz * cz) + s.Wzz * cz * cz;
    sums.rate[i] = limit * (s.inverse_mass + turning);
}

BIRM3D_IN_LANE_LOOP Sum total(LaneSums& sums) {
    return {lane_sum(sums.fx), lane_sum(sums.fy), lane_sum(sums.fz),  lane_sum(sums.tx),
            lane_sum(sums.ty), lane_sum(sums.tz), lane_sum(sums.rate)};
}

BIRM3D_LANE_LOOP Sum friction_of_block(const Sliding& s, const Places& at, const BlockContact& contact) {
    LaneSums sums;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        // u = v + w x r
        const double x = at.x[i], y = at.y[i], z = at.z[i];
        friction_of_node(s, at, contact, i, s.vx + s.wy * z - s.wz * y, s.vy + s.wz * x - s.wx * z,
                         s.vz + s.wx * y - s.wy * x, sums);
    }
    return total(sums);
}

// `rolls`: 1 for wheels that roll, 0 for locked ones.
BIRM3D_LANE_LOOP Sum friction_of_tread(const Sliding& s, const TreadBlock& tread, double rolls,
                                       const Places& at, const BlockContact& contact) {
    LaneSums sums;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = at.x[i], y = at.y[i], z = at.z[i];
        const double forward = rolls * (s.vx + s.wy * tread.axle_t[i] - s.wz * tread.axle_s[i]);
        friction_of_node(s, at, contact, i, s.vx + s.wy * z - s.wz * y + forward * tread.turn_r[i],
                         s.vy + s.wz * x - s.wx * z, s.vz + s.wx * y - s.wy * x + forward * tread.turn_t[i],
                         sums);
    }
    return total(sums);
}

Sliding sliding_of(const RigidBody& body, double mu, double full_speed, const Twist& motion) {
    const Vec3& v = motion.velocity;
    const Vec3& w = motion.angular_velocity;
    const Mat3& W = body.inverse_inertia;
    return {mu,           full_speed,        v.x(),   v.y(),   v.z(),   w.x(),         w.y(),
            w.z(),        body.inverse_mass, W(0, 0), W(1, 1), W(2, 2), 2.0 * W(0, 1), 2.0 * W(0, 2),
            2.0 * W(1, 2)};
}

void add(const Sum& sum, SkinForces& forces) {
    forces.friction += {Vec3(sum.fx, sum.fy, sum.fz), Vec3(sum.tx, sum.ty, sum.tz)};
    forces.friction_rate += sum.rate;
}

}  // namespace

void add_friction(const RigidBody& body, double mu, double full_speed, const Twist& motion,
                  const Places& places, const BlockContact& contact, SkinForces& forces) {
    add(friction_of_block(sliding_of(body, mu, full_speed, motion), places, contact), forces);
}

void add_tread_friction(const RigidBody& body, double mu, double full_speed, const Twist& motion,
                        const TreadBlock& tread, bool rolls, const Places& places,
                        const BlockContact& contact, SkinForces& forces) {
    const Sliding sliding = sliding_of(body, mu, full_speed, motion);
    add(friction_of_tread(sliding, tread, rolls ? 1.0 : 0.0, places, contact), forces);
}

}  // namespace birm3d
