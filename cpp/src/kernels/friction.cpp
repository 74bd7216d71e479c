#include "birm3d/kernels/friction.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Plain numbers for the loop: mu, the speed of full friction, twist.
struct Sliding {
    double mu, full_speed;
    double vx, vy, vz, wx, wy, wz;
};

struct Force {
    double fx, fy, fz, tx, ty, tz;
};

// Sums of q P, q [r] P and -q [r] P [r], P = 1 - n n^T.
struct Resistance {
    double xx, xy, xz, yy, yz, zz;
    double rxx, rxy, rxz, ryx, ryy, ryz, rzx, rzy, rzz;
    double rrxx, rrxy, rrxz, rryy, rryz, rrzz;
};

// Also q, the force for each unit of sliding velocity, of nodes that slide slowly.
BIRM3D_LANE_LOOP Force friction_of_block(const Sliding& s, const Places& at, const BlockContact& contact,
                                         Lanes& q) {
    alignas(64) Lanes fx, fy, fz, tx, ty, tz;
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
        const double per_speed = s.mu * contact.pressure[i] / (speed > s.full_speed ? speed : s.full_speed);
        q[i] = speed < tolerance::fast_sliding * s.full_speed ? per_speed : 0.0;
        fx[i] = -per_speed * sx;
        fy[i] = -per_speed * sy;
        fz[i] = -per_speed * sz;
        tx[i] = y * fz[i] - z * fy[i];
        ty[i] = z * fx[i] - x * fz[i];
        tz[i] = x * fy[i] - y * fx[i];
    }
    return {lane_sum(fx), lane_sum(fy), lane_sum(fz), lane_sum(tx), lane_sum(ty), lane_sum(tz)};
}

BIRM3D_LANE_LOOP Resistance resistance_of_block(const Lanes& of, const Places& at,
                                                const BlockContact& contact) {
    alignas(64) Lanes xx, xy, xz, yy, yz, zz, rxx, rxy, rxz, ryx, ryy, ryz, rzx, rzy, rzz;
    alignas(64) Lanes rrxx, rrxy, rrxz, rryy, rryz, rrzz;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double q = of[i], x = at.x[i], y = at.y[i], z = at.z[i];
        const double nx = contact.nx[i], ny = contact.ny[i], nz = contact.nz[i];
        const double qx = q * nx, qy = q * ny, qz = q * nz;
        xx[i] = q - qx * nx;
        yy[i] = q - qy * ny;
        zz[i] = q - qz * nz;
        xy[i] = -qx * ny;
        xz[i] = -qx * nz;
        yz[i] = -qy * nz;
        rxx[i] = y * xz[i] - z * xy[i];
        rxy[i] = y * yz[i] - z * yy[i];
        rxz[i] = y * zz[i] - z * yz[i];
        ryx[i] = z * xx[i] - x * xz[i];
        ryy[i] = z * xy[i] - x * yz[i];
        ryz[i] = z * xz[i] - x * zz[i];
        rzx[i] = x * xy[i] - y * xx[i];
        rzy[i] = x * yy[i] - y * xy[i];
        rzz[i] = x * yz[i] - y * xz[i];
        rrxx[i] = y * rxz[i] - z * rxy[i];
        rrxy[i] = y * ryz[i] - z * ryy[i];
        rrxz[i] = y * rzz[i] - z * rzy[i];
        rryy[i] = z * ryx[i] - x * ryz[i];
        rryz[i] = z * rzx[i] - x * rzz[i];
        rrzz[i] = x * rzy[i] - y * rzx[i];
    }
    return {lane_sum(xx),   lane_sum(xy),   lane_sum(xz),  lane_sum(yy),   lane_sum(yz),   lane_sum(zz),
            lane_sum(rxx),  lane_sum(rxy),  lane_sum(rxz), lane_sum(ryx),  lane_sum(ryy),  lane_sum(ryz),
            lane_sum(rzx),  lane_sum(rzy),  lane_sum(rzz), lane_sum(rrxx), lane_sum(rrxy), lane_sum(rrxz),
            lane_sum(rryy), lane_sum(rryz), lane_sum(rrzz)};
}

// Sums of q, q r and q r r^T.
struct Moments {
    double q, x, y, z, xx, yy, zz, xy, xz, yz;
};

BIRM3D_LANE_LOOP Moments moments_of_block(const Lanes& q, const Places& at) {
    alignas(64) Lanes sum, sx, sy, sz, xx, yy, zz, xy, xz, yz;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = at.x[i], y = at.y[i], z = at.z[i];
        sum[i] = q[i];
        sx[i] = q[i] * x;
        sy[i] = q[i] * y;
        sz[i] = q[i] * z;
        xx[i] = sx[i] * x;
        yy[i] = sy[i] * y;
        zz[i] = sz[i] * z;
        xy[i] = sx[i] * y;
        xz[i] = sx[i] * z;
        yz[i] = sy[i] * z;
    }
    return {lane_sum(sum), lane_sum(sx), lane_sum(sy), lane_sum(sz), lane_sum(xx),
            lane_sum(yy),  lane_sum(zz), lane_sum(xy), lane_sum(xz), lane_sum(yz)};
}

Mat3 crossing(const Vec3& a) {
    Mat3 cross;
    cross << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    return cross;
}

Mat6 on_surface(const Lanes& slow, const Places& places, const BlockContact& contact) {
    const Resistance of = resistance_of_block(slow, places, contact);
    Mat6 resistance;
    resistance << of.xx, of.xy, of.xz, of.rxx, of.ryx, of.rzx,  //
        of.xy, of.yy, of.yz, of.rxy, of.ryy, of.rzy,            //
        of.xz, of.yz, of.zz, of.rxz, of.ryz, of.rzz,            //
        of.rxx, of.rxy, of.rxz, of.rrxx, of.rrxy, of.rrxz,      //
        of.ryx, of.ryy, of.ryz, of.rrxy, of.rryy, of.rryz,      //
        of.rzx, of.rzy, of.rzz, of.rrxz, of.rryz, of.rrzz;
    return resistance;
}

// The same where all nodes have one normal, of sums of q, q r and q r r^T: half as many.
Mat6 on_plane(double q, const Vec3& qr, const Mat3& qrr, const Vec3& normal) {
    const Mat3 n = crossing(normal), along = -n * n, turned = crossing(qr) * along;
    Mat6 resistance;
    resistance << q * along, turned.transpose(), turned, qrr.trace() * Mat3::Identity() - qrr + n * qrr * n;
    return resistance;
}

Mat6 on_plane(const Lanes& slow, const Places& places, const Vec3& normal) {
    const Moments of = moments_of_block(slow, places);
    Mat3 qrr;
    qrr << of.xx, of.xy, of.xz, of.xy, of.yy, of.yz, of.xz, of.yz, of.zz;
    return on_plane(of.q, {of.x, of.y, of.z}, qrr, normal);
}

Vec6 column(const Twist& twist) {
    Vec6 both;
    both << twist.velocity, twist.angular_velocity;
    return both;
}

}  // namespace

void add_friction(double mu, double full_speed, const Twist& motion, const Places& places,
                  const BlockContact& contact, const Vec3* common_normal, Rubbing& rubbing) {
    const Vec3& v = motion.velocity;
    const Vec3& w = motion.angular_velocity;
    alignas(64) Lanes slow;
    const Force by =
        friction_of_block({mu, full_speed, v.x(), v.y(), v.z(), w.x(), w.y(), w.z()}, places, contact, slow);
    rubbing.friction += {Vec3(by.fx, by.fy, by.fz), Vec3(by.tx, by.ty, by.tz)};
    if (std::none_of(slow.begin(), slow.end(), [](double q) { return q > 0.0; })) return;
    rubbing.resistance +=
        common_normal != nullptr ? on_plane(slow, places, *common_normal) : on_surface(slow, places, contact);
}

Mat6 resistance(double q, const Vec3& r, const Vec3& normal) {
    return on_plane(q, q * r, q * r * r.transpose(), normal);
}

Twist settled(const Twist& motion, const Twist& before, const Mat6& resistance, double dt,
              const Mat6& inertia) {
    const Mat6 half = 0.5 * dt * resistance;
    const Vec6 loss = (inertia + half).ldlt().solve(half * (column(motion) - column(before)));
    return {motion.velocity - loss.head<3>(), motion.angular_velocity - loss.tail<3>()};
}

}  // namespace birm3d
