#include "kernels/slab_chain_columns.hpp"
#include "base/block_loop.hpp"

#include <algorithm>
#include <cmath>

namespace birm3d {

namespace {

// Speed at an arm of the motion (x, y, z).
BIRM3D_INLINE double speed_x(double x, double z, double arm_y) {
    return x - arm_y * z;
}
BIRM3D_INLINE double speed_y(double y, double z, double arm_x) {
    return y + arm_x * z;
}

BIRM3D_INLINE double rounded(double x, double y, double soft) {
    return std::sqrt(x * x + y * y + soft * soft);
}

BIRM3D_BLOCK_LOOP void settle(SlabBlock& block, SlabCorners& corner, std::size_t first, std::size_t end,
                              double soft, BlockColumn& worst) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = speed_x(block.q_x[i], block.q_z[i], corner.arm_y[i]),
                     y = speed_y(block.q_y[i], block.q_z[i], corner.arm_x[i]);
        const double size = rounded(x, y, soft * block.reach[i]);
        const bool with_friction = block.limit[i] > 0.0;
        const double eta = with_friction ? size : 1.0;
        corner.eta[i] = eta;
        corner.law_x[i] = with_friction ? x / eta : 0.0, corner.law_y[i] = with_friction ? y / eta : 0.0;
        const double dx = std::abs(corner.law_x[i] - corner.used_x[i]),
                     dy = std::abs(corner.law_y[i] - corner.used_y[i]);
        worst[i] = dx > worst[i] ? dx : worst[i];
        worst[i] = dy > worst[i] ? dy : worst[i];
    }
}

// Gradient and curvature without friction.
BIRM3D_BLOCK_LOOP void begin_newton_steps(SlabBlock& block, std::size_t first, std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        block.step_x[i] = block.mass[i] * (block.q_x[i] - block.start_x[i]);
        block.step_y[i] = block.mass[i] * (block.q_y[i] - block.start_y[i]);
        block.step_z[i] = block.mass[i] * (block.q_z[i] - block.start_z[i]);
        block.xx[i] = block.yy[i] = block.zz[i] = block.mass[i];
        block.xy[i] = block.xz[i] = block.yz[i] = 0.0;
    }
}

BIRM3D_BLOCK_LOOP void add_friction(SlabBlock& block, const SlabCorners& corner, std::size_t first,
                                    std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double nx = corner.law_x[i], ny = corner.law_y[i], yx = corner.dual_x[i], yy = corner.dual_y[i];
        const double rx = corner.arm_x[i], ry = corner.arm_y[i], limit = block.limit[i];
        block.step_x[i] += limit * nx, block.step_y[i] += limit * ny,
            block.step_z[i] += limit * (rx * ny - ry * nx);
        const double scale = limit / corner.eta[i];
        const double a_xx = scale * (1.0 - nx * yx), a_yy = scale * (1.0 - ny * yy);
        const double a_xy = -0.5 * scale * (nx * yy + ny * yx);
        const double torque_x = a_xy * rx - a_xx * ry, torque_y = a_yy * rx - a_xy * ry;
        block.xx[i] += a_xx, block.xy[i] += a_xy, block.yy[i] += a_yy, block.xz[i] += torque_x,
            block.yz[i] += torque_y;
        block.zz[i] += torque_y * rx - torque_x * ry;
    }
}

// The inverse of the curvature through its minors, and Newton's step.
BIRM3D_BLOCK_LOOP void end_newton_steps(SlabBlock& block, std::size_t first, std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double xx = block.xx[i], yy = block.yy[i], zz = block.zz[i], xy = block.xy[i], xz = block.xz[i],
                     yz = block.yz[i];
        const double minor_xx = yy * zz - yz * yz, minor_xy = xz * yz - xy * zz, minor_xz = xy * yz - xz * yy;
        const double scale = 1.0 / (xx * minor_xx + xy * minor_xy + xz * minor_xz);
        const double inverse_xx = scale * minor_xx, inverse_xy = scale * minor_xy,
                     inverse_xz = scale * minor_xz, inverse_yy = scale * (xx * zz - xz * xz),
                     inverse_yz = scale * (xy * xz - xx * yz), inverse_zz = scale * (xx * yy - xy * xy);
        block.xx[i] = inverse_xx, block.xy[i] = inverse_xy, block.xz[i] = inverse_xz;
        block.yy[i] = inverse_yy, block.yz[i] = inverse_yz, block.zz[i] = inverse_zz;
        const double x = block.step_x[i], y = block.step_y[i], z = block.step_z[i];
        block.step_x[i] = -(inverse_xx * x + inverse_xy * y + inverse_xz * z);
        block.step_y[i] = -(inverse_xy * x + inverse_yy * y + inverse_yz * z);
        block.step_z[i] = -(inverse_xz * x + (inverse_yz * y + inverse_zz * z));
    }
}

// J mobility K^T of two places of each slab.
BIRM3D_BLOCK_LOOP void respond(const SlabBlock& block, const BlockColumn& arm_x, const BlockColumn& arm_y,
                               const BlockColumn& other_x, const BlockColumn& other_y, std::size_t first,
                               std::size_t end, SlabResponse& to) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double tx = -other_y[i], ty = other_x[i];
        const double xx = block.xx[i] + block.xz[i] * tx, xy = block.xy[i] + block.yz[i] * tx,
                     xz = block.xz[i] + block.zz[i] * tx;
        const double yx = block.xy[i] + block.xz[i] * ty, yy = block.yy[i] + block.yz[i] * ty,
                     yz = block.yz[i] + block.zz[i] * ty;
        to.xx[i] = speed_x(xx, xz, arm_y[i]), to.yx[i] = speed_y(xy, xz, arm_x[i]);
        to.xy[i] = speed_x(yx, yz, arm_y[i]), to.yy[i] = speed_y(yy, yz, arm_x[i]);
    }
}

BIRM3D_BLOCK_LOOP void find_speeds(SlabBlock& block, std::size_t first, std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = block.q_x[i] + block.step_x[i], y = block.q_y[i] + block.step_y[i],
                     z = block.q_z[i] + block.step_z[i];
        block.low.speed_x[i] = speed_x(x, z, block.low.arm_y[i]),
        block.low.speed_y[i] = speed_y(y, z, block.low.arm_x[i]);
        block.high.speed_x[i] = speed_x(x, z, block.high.arm_y[i]),
        block.high.speed_y[i] = speed_y(y, z, block.high.arm_x[i]);
    }
}

BIRM3D_BLOCK_LOOP void pull(SlabBlock& block, const SlabEnd& at, double sign, std::size_t first,
                            std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = sign * at.pull_x[i], y = sign * at.pull_y[i], z = at.arm_x[i] * y - at.arm_y[i] * x;
        block.step_x[i] += block.xx[i] * x + block.xy[i] * y + block.xz[i] * z;
        block.step_y[i] += block.xy[i] * x + block.yy[i] * y + block.yz[i] * z;
        block.step_z[i] += block.xz[i] * x + (block.yz[i] * y + block.zz[i] * z);
    }
}

BIRM3D_BLOCK_LOOP void find_values(const SlabBlock& block, const SlabCorners& corner, double soft,
                                   double fraction, std::size_t first, std::size_t end, BlockColumn& to) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = block.q_x[i] + fraction * block.step_x[i],
                     y = block.q_y[i] + fraction * block.step_y[i],
                     z = block.q_z[i] + fraction * block.step_z[i];
        const double ux = speed_x(x, z, corner.arm_y[i]), uy = speed_y(y, z, corner.arm_x[i]);
        to[i] = block.limit[i] * rounded(ux, uy, soft * block.reach[i]);
    }
}

BIRM3D_BLOCK_LOOP void find_kinetic(const SlabBlock& block, double fraction, std::size_t first,
                                    std::size_t end, BlockColumn& to) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = block.q_x[i] + fraction * block.step_x[i] - block.start_x[i],
                     y = block.q_y[i] + fraction * block.step_y[i] - block.start_y[i],
                     z = block.q_z[i] + fraction * block.step_z[i] - block.start_z[i];
        to[i] = 0.5 * block.mass[i] * (x * x + y * y + z * z);
    }
}

BIRM3D_BLOCK_LOOP void move(SlabBlock& block, double fraction, std::size_t first, std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        block.q_x[i] += fraction * block.step_x[i];
        block.q_y[i] += fraction * block.step_y[i];
        block.q_z[i] += fraction * block.step_z[i];
    }
}

BIRM3D_BLOCK_LOOP void use_law(const SlabBlock& block, SlabCorners& corner, double fraction,
                               std::size_t first, std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const bool with_friction = block.limit[i] > 0.0;
        const double per = fraction / corner.eta[i];
        const double ux = per * speed_x(block.step_x[i], block.step_z[i], corner.arm_y[i]),
                     uy = per * speed_y(block.step_y[i], block.step_z[i], corner.arm_x[i]);
        const double nx = corner.law_x[i], ny = corner.law_y[i], yx = corner.dual_x[i], yy = corner.dual_y[i];
        const double nu = nx * ux + ny * uy, yu = yx * ux + yy * uy;
        corner.used_x[i] = with_friction ? nx + ux - 0.5 * (yx * nu + nx * yu) : 0.0;
        corner.used_y[i] = with_friction ? ny + uy - 0.5 * (yy * nu + ny * yu) : 0.0;
        const double x = nx + ux - yx * nu, y = ny + uy - yy * nu, size = std::sqrt(x * x + y * y);
        const double most = 1.0 < size ? size : 1.0;
        corner.dual_x[i] = with_friction ? x / most : 0.0;
        corner.dual_y[i] = with_friction ? y / most : 0.0;
    }
}

// Displacement of a pin's place in the drift, with the Cayley rotation of drift() in integrate.cpp.
BIRM3D_BLOCK_LOOP void drift_end(const SlabBlock& block, SlabEnd& at, double drift, std::size_t first,
                                 std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double half = 0.5 * drift * (block.q_z[i] / block.gyration[i]),
                     scale = 2.0 * half / (1.0 + half * half);
        at.drift_x[i] = drift * block.q_x[i] + scale * (-at.place_y[i] - half * at.place_x[i]);
        at.drift_y[i] = drift * block.q_y[i] + scale * (at.place_x[i] - half * at.place_y[i]);
        at.speed_x[i] = speed_x(block.q_x[i], block.q_z[i], at.arm_y[i]);
        at.speed_y[i] = speed_y(block.q_y[i], block.q_z[i], at.arm_x[i]);
    }
}

}  // namespace

double settle_laws(const SlabRange& slabs, double soft) {
    BlockColumn worst{};
    for (SlabCorners& corner : slabs.block.corners)
        settle(slabs.block, corner, slabs.first, slabs.end, soft, worst);
    return *std::max_element(worst.begin(), worst.end());
}

void start_from_laws(const SlabRange& slabs, double soft) {
    for (SlabCorners& corner : slabs.block.corners)
        corner.used_x.fill(0.0), corner.used_y.fill(0.0);
    settle_laws(slabs, soft);
    for (SlabCorners& corner : slabs.block.corners)
        corner.dual_x = corner.law_x, corner.dual_y = corner.law_y;
}

void find_newton_steps(const SlabRange& slabs, bool with_friction) {
    begin_newton_steps(slabs.block, slabs.first, slabs.end);
    if (with_friction)
        for (const SlabCorners& corner : slabs.block.corners)
            add_friction(slabs.block, corner, slabs.first, slabs.end);
    end_newton_steps(slabs.block, slabs.first, slabs.end);
}

void find_responses(const SlabRange& slabs) {
    SlabBlock& block = slabs.block;
    respond(block, block.low.arm_x, block.low.arm_y, block.low.arm_x, block.low.arm_y, slabs.first, slabs.end,
            block.at_low);
    respond(block, block.high.arm_x, block.high.arm_y, block.high.arm_x, block.high.arm_y, slabs.first,
            slabs.end, block.at_high);
    respond(block, block.low.arm_x, block.low.arm_y, block.high.arm_x, block.high.arm_y, slabs.first,
            slabs.end, block.across);
    find_speeds(block, slabs.first, slabs.end);
}

void add_pulls(const SlabRange& slabs) {
    pull(slabs.block, slabs.block.low, -1.0, slabs.first, slabs.end);
    pull(slabs.block, slabs.block.high, 1.0, slabs.first, slabs.end);
}

// Sums are in the order of the slabs.
double add_value(const SlabRange& slabs, double soft, double fraction, double sum) {
    const SlabBlock& block = slabs.block;
    BlockColumn kinetic;
    std::array<BlockColumn, 4> corner_loss;
    find_kinetic(block, fraction, slabs.first, slabs.end, kinetic);
    for (std::size_t k = 0; k < corner_loss.size(); ++k)
        find_values(block, block.corners[k], soft, fraction, slabs.first, slabs.end, corner_loss[k]);
    for (std::size_t i = slabs.first; i < slabs.end; ++i) {
        sum += kinetic[i];
        for (const BlockColumn& corner : corner_loss)
            sum += corner[i];
    }
    return sum;
}

void go_on(const SlabRange& slabs, double fraction) {
    move(slabs.block, fraction, slabs.first, slabs.end);
}

void take_step(const SlabRange& slabs, double fraction) {
    for (SlabCorners& corner : slabs.block.corners)
        use_law(slabs.block, corner, fraction, slabs.first, slabs.end);
    go_on(slabs, fraction);
}

void back_to_start(const SlabRange& slabs) {
    SlabBlock& block = slabs.block;
    for (std::size_t i = slabs.first; i < slabs.end; ++i)
        block.q_x[i] = block.start_x[i], block.q_y[i] = block.start_y[i], block.q_z[i] = block.start_z[i];
}

void find_drifts(const SlabRange& slabs, double drift) {
    for (SlabEnd* at : {&slabs.block.low, &slabs.block.high})
        drift_end(slabs.block, *at, drift, slabs.first, slabs.end);
}

}  // namespace birm3d
