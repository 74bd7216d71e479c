#include "kernels/friction.hpp"

#include <Eigen/Cholesky>

#include "kernels/simd_table.hpp"

namespace birm3d {

namespace {

Mat3 crossing(const Vec3& a) {
    Mat3 cross;
    cross << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    return cross;
}

Mat6 on_surface(const BlockColumn& slow, const SlidingNodes& nodes) {
    const ResistanceSums sums = simd.find_resistance(slow.data(), nodes);
    Mat6 resistance;
    resistance << sums.xx, sums.xy, sums.xz, sums.rxx, sums.ryx, sums.rzx,  //
        sums.xy, sums.yy, sums.yz, sums.rxy, sums.ryy, sums.rzy,            //
        sums.xz, sums.yz, sums.zz, sums.rxz, sums.ryz, sums.rzz,            //
        sums.rxx, sums.rxy, sums.rxz, sums.rrxx, sums.rrxy, sums.rrxz,      //
        sums.ryx, sums.ryy, sums.ryz, sums.rrxy, sums.rryy, sums.rryz,      //
        sums.rzx, sums.rzy, sums.rzz, sums.rrxz, sums.rryz, sums.rrzz;
    return resistance;
}

// The same where all nodes have one normal, of sums of q, q r and q r r^T: half as many.
Mat6 on_plane(double q, const Vec3& qr, const Mat3& qrr, const Vec3& normal) {
    const Mat3 n = crossing(normal), along = -n * n, turned = crossing(qr) * along;
    Mat6 resistance;
    resistance << q * along, turned.transpose(), turned, qrr.trace() * Mat3::Identity() - qrr + n * qrr * n;
    return resistance;
}

Mat6 on_plane(const BlockColumn& slow, const SlidingNodes& nodes, const Vec3& normal) {
    const Moments sums = simd.find_moments(slow.data(), nodes);
    Mat3 qrr;
    qrr << sums.xx, sums.xy, sums.xz, sums.xy, sums.yy, sums.yz, sums.xz, sums.yz, sums.zz;
    return on_plane(sums.q, {sums.x, sums.y, sums.z}, qrr, normal);
}

Vec6 column(const Twist& twist) {
    Vec6 both;
    both << twist.velocity, twist.angular_velocity;
    return both;
}

}  // namespace

void add_friction(double mu, double full_speed, const Twist& motion, const Places& places,
                  const BlockContact& contact, const Vec3* common_normal, FrictionLoad& friction_load) {
    const Vec3& v = motion.velocity;
    const Vec3& w = motion.angular_velocity;
    const SlidingNodes nodes{places.x.data(),
                             places.y.data(),
                             places.z.data(),
                             contact.nx.data(),
                             contact.ny.data(),
                             contact.nz.data(),
                             contact.normal_force.data()};
    alignas(64) BlockColumn slow;
    const FrictionSums by =
        simd.find_friction({mu, full_speed, v.x(), v.y(), v.z(), w.x(), w.y(), w.z()}, nodes, slow.data());
    friction_load.friction += {Vec3(by.fx, by.fy, by.fz), Vec3(by.tx, by.ty, by.tz)};
    if (!by.slow) return;
    friction_load.resistance +=
        common_normal != nullptr ? on_plane(slow, nodes, *common_normal) : on_surface(slow, nodes);
}

Mat6 resistance(double q, const Vec3& r, const Vec3& normal) {
    return on_plane(q, q * r, q * r * r.transpose(), normal);
}

Twist settled(const Twist& motion, const Twist& before, const Mat6& resistance, double dt,
              const Mat6& inertia, const Mat6& support) {
    const Mat6 half = 0.5 * dt * resistance;
    const Vec6 free = column(motion);
    const Vec6 loss =
        (inertia + support + half).ldlt().solve(half * (free - column(before)) + support * free);
    return {motion.velocity - loss.head<3>(), motion.angular_velocity - loss.tail<3>()};
}

}  // namespace birm3d
