// Compiled once for each instruction set; see base/packet.hpp for what that forbids.
#include "kernels/friction_simd.hpp"

#include "base/packet.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d::BIRM3D_INSTRUCTION_SET {

namespace {

// A row of zeros adds nothing to any sum.
BIRM3D_INLINE bool is_zero(const Packet& row) {
    return !any_above(row, 0.0);
}

BIRM3D_INLINE void add(Packet& sum, const Packet& row) {
    sum = sum + row;
}

}  // namespace

FrictionSums find_friction(const Sliding& sliding, const SlidingNodes& nodes, double* q);
ResistanceSums find_resistance(const double* q, const SlidingNodes& nodes);
Moments find_moments(const double* q, const SlidingNodes& nodes);

FrictionSums find_friction(const Sliding& sliding, const SlidingNodes& nodes, double* q) {
    const Packet zero = 0.0, full_speed = sliding.full_speed;
    Packet fx = zero, fy = zero, fz = zero, tx = zero, ty = zero, tz = zero, stiffest = zero;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        const Packet normal_force = Packet::load(nodes.normal_force + i);
        if (is_zero(normal_force)) {
            zero.store(q + i);
            continue;
        }
        const Packet x = Packet::load(nodes.x + i), y = Packet::load(nodes.y + i),
                     z = Packet::load(nodes.z + i);
        const Packet nx = Packet::load(nodes.nx + i), ny = Packet::load(nodes.ny + i),
                     nz = Packet::load(nodes.nz + i);
        // Sliding velocity u = v + w x r, without its normal part.
        const Packet ux = sliding.vx + sliding.wy * z - sliding.wz * y,
                     uy = sliding.vy + sliding.wz * x - sliding.wx * z,
                     uz = sliding.vz + sliding.wx * y - sliding.wy * x;
        const Packet un = ux * nx + uy * ny + uz * nz;
        const Packet sx = ux - un * nx, sy = uy - un * ny, sz = uz - un * nz;
        const Packet speed = square_root(sx * sx + sy * sy + sz * sz);
        const Packet per_speed = sliding.mu * normal_force / greater(speed, full_speed);
        const Packet slow = where_above(tolerance::fast_sliding * full_speed, speed, per_speed, zero);
        slow.store(q + i);
        stiffest = greater(stiffest, slow);
        const Packet px = per_speed * sx, py = per_speed * sy, pz = per_speed * sz;
        fx = fx - px, fy = fy - py, fz = fz - pz;
        add(tx, z * py - y * pz);
        add(ty, x * pz - z * px);
        add(tz, y * px - x * py);
    }
    return {sum_of(fx), sum_of(fy), sum_of(fz), sum_of(tx), sum_of(ty), sum_of(tz), !is_zero(stiffest)};
}

ResistanceSums find_resistance(const double* q, const SlidingNodes& nodes) {
    const Packet zero = 0.0;
    Packet xx = zero, xy = zero, xz = zero, yy = zero, yz = zero, zz = zero;
    Packet rxx = zero, rxy = zero, rxz = zero, ryx = zero, ryy = zero, ryz = zero, rzx = zero, rzy = zero,
           rzz = zero;
    Packet rrxx = zero, rrxy = zero, rrxz = zero, rryy = zero, rryz = zero, rrzz = zero;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        const Packet per_speed = Packet::load(q + i);
        if (is_zero(per_speed)) continue;
        const Packet x = Packet::load(nodes.x + i), y = Packet::load(nodes.y + i),
                     z = Packet::load(nodes.z + i);
        const Packet nx = Packet::load(nodes.nx + i), ny = Packet::load(nodes.ny + i),
                     nz = Packet::load(nodes.nz + i);
        const Packet qx = per_speed * nx, qy = per_speed * ny;
        const Packet pxx = per_speed - qx * nx, pxy = -1.0 * qx * ny, pxz = -1.0 * qx * nz,
                     pyy = per_speed - qy * ny, pyz = -1.0 * qy * nz, pzz = per_speed - per_speed * nz * nz;
        add(xx, pxx), add(xy, pxy), add(xz, pxz), add(yy, pyy), add(yz, pyz), add(zz, pzz);
        const Packet cxx = y * pxz - z * pxy, cxy = y * pyz - z * pyy, cxz = y * pzz - z * pyz;
        const Packet cyx = z * pxx - x * pxz, cyy = z * pxy - x * pyz, cyz = z * pxz - x * pzz;
        const Packet czx = x * pxy - y * pxx, czy = x * pyy - y * pxy, czz = x * pyz - y * pxz;
        add(rxx, cxx), add(rxy, cxy), add(rxz, cxz);
        add(ryx, cyx), add(ryy, cyy), add(ryz, cyz);
        add(rzx, czx), add(rzy, czy), add(rzz, czz);
        add(rrxx, y * cxz - z * cxy), add(rrxy, y * cyz - z * cyy), add(rrxz, y * czz - z * czy);
        add(rryy, z * cyx - x * cyz), add(rryz, z * czx - x * czz), add(rrzz, x * czy - y * czx);
    }
    return {sum_of(xx),  sum_of(xy),   sum_of(xz),   sum_of(yy),   sum_of(yz),   sum_of(zz),   sum_of(rxx),
            sum_of(rxy), sum_of(rxz),  sum_of(ryx),  sum_of(ryy),  sum_of(ryz),  sum_of(rzx),  sum_of(rzy),
            sum_of(rzz), sum_of(rrxx), sum_of(rrxy), sum_of(rrxz), sum_of(rryy), sum_of(rryz), sum_of(rrzz)};
}

Moments find_moments(const double* q, const SlidingNodes& nodes) {
    const Packet zero = 0.0;
    Packet sum = zero, sx = zero, sy = zero, sz = zero, xx = zero, yy = zero, zz = zero, xy = zero, xz = zero,
           yz = zero;
    for (std::size_t i = 0; i < block_size; i += packet_length) {
        const Packet per_speed = Packet::load(q + i);
        if (is_zero(per_speed)) continue;
        const Packet x = Packet::load(nodes.x + i), y = Packet::load(nodes.y + i),
                     z = Packet::load(nodes.z + i);
        const Packet qx = per_speed * x, qy = per_speed * y, qz = per_speed * z;
        add(sum, per_speed), add(sx, qx), add(sy, qy), add(sz, qz);
        add(xx, qx * x), add(yy, qy * y), add(zz, qz * z);
        add(xy, qx * y), add(xz, qx * z), add(yz, qy * z);
    }
    return {sum_of(sum), sum_of(sx), sum_of(sy), sum_of(sz), sum_of(xx),
            sum_of(yy),  sum_of(zz), sum_of(xy), sum_of(xz), sum_of(yz)};
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
