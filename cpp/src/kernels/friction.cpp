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

BIRM3D_LANE_LOOP Sum friction_of_block(const Sliding& s, const Places& at, const BlockContact& contact) {
    alignas(64) Lanes fx, fy, fz, tx, ty, tz, rate;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = at.x[i], y = at.y[i], z = at.z[i];
        const double nx = contact.nx[i], ny = contact.ny[i], nz = contact.nz[i];
        // Sliding velocity u = v + w x r, without its normal part.
        const double ux = s.vx + s.wy * z - s.wz * y, uy = s.vy + s.wz * x - s.wx * z,
                     uz = s.vz + s.wx * y - s.wy * x;
        const double un = ux * nx + uy * ny + uz * nz;
        const double sx = ux - un * nx, sy = uy - un * ny, sz = uz - un * nz;
        const double speed = std::sqrt(sx * sx + sy * sy + sz * sz);
        const double per_speed = 1.0 / (speed > s.full_speed ? speed : s.full_speed);
        const double limit = s.mu * contact.pressure[i];
        const double px = -sx * per_speed, py = -sy * per_speed, pz = -sz * per_speed;
        fx[i] = limit * px;
        fy[i] = limit * py;
        fz[i] = limit * pz;
        // c = r x direction; torque = limit * c.
        const double cx = y * pz - z * py, cy = z * px - x * pz, cz = x * py - y * px;
        tx[i] = limit * cx;
        ty[i] = limit * cy;
        tz[i] = limit * cz;
        // Inverse effective mass along the sliding direction (Eq. 1's denominator).
        const double turning =
            cx * (s.Wxx * cx + s.Wxy * cy + s.Wxz * cz) + cy * (s.Wyy * cy + s.Wyz * cz) + s.Wzz * cz * cz;
        rate[i] = limit * (s.inverse_mass + turning);
    }
    return {lane_sum(fx), lane_sum(fy), lane_sum(fz),  lane_sum(tx),
            lane_sum(ty), lane_sum(tz), lane_sum(rate)};
}

}  // namespace

void add_friction(const RigidBody& body, double mu, double full_speed, const Twist& motion,
                  const Places& places, const BlockContact& contact, SkinForces& forces) {
    const Vec3& v = motion.velocity;
    const Vec3& w = motion.angular_velocity;
    const Mat3& W = body.inverse_inertia;
    const Sliding sliding{
        mu,           full_speed,        v.x(),   v.y(),   v.z(),   w.x(),         w.y(),
        w.z(),        body.inverse_mass, W(0, 0), W(1, 1), W(2, 2), 2.0 * W(0, 1), 2.0 * W(0, 2),
        2.0 * W(1, 2)};
    const Sum sum = friction_of_block(sliding, places, contact);
    forces.friction += {Vec3(sum.fx, sum.fy, sum.fz), Vec3(sum.tx, sum.ty, sum.tz)};
    forces.friction_rate += sum.rate;
}

}  // namespace birm3d
