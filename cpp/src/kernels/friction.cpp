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
    const ResistanceSums of = simd.find_resistance(slow.data(), nodes);
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

Mat6 on_plane(const BlockColumn& slow, const SlidingNodes& nodes, const Vec3& normal) {
    const Moments of = simd.find_moments(slow.data(), nodes);
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
