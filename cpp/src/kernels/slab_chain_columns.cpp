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

BIRM3D_BLOCK_LOOP void settle(SlabBlock& b, SlabCorners& c, std::size_t first, std::size_t end, double soft,
                              BlockColumn& worst) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = speed_x(b.q_x[i], b.q_z[i], c.arm_y[i]), y = speed_y(b.q_y[i], b.q_z[i], c.arm_x[i]);
        const double size = rounded(x, y, soft * b.reach[i]);
        const bool with_friction = b.limit[i] > 0.0;
        const double eta = with_friction ? size : 1.0;
        c.eta[i] = eta;
        c.law_x[i] = with_friction ? x / eta : 0.0, c.law_y[i] = with_friction ? y / eta : 0.0;
        const double dx = std::abs(c.law_x[i] - c.used_x[i]), dy = std::abs(c.law_y[i] - c.used_y[i]);
        worst[i] = dx > worst[i] ? dx : worst[i];
        worst[i] = dy > worst[i] ? dy : worst[i];
    }
}

// Gradient and curvature without friction.
BIRM3D_BLOCK_LOOP void begin_newton_steps(SlabBlock& b, std::size_t first, std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        b.step_x[i] = b.mass[i] * (b.q_x[i] - b.start_x[i]);
        b.step_y[i] = b.mass[i] * (b.q_y[i] - b.start_y[i]);
        b.step_z[i] = b.mass[i] * (b.q_z[i] - b.start_z[i]);
        b.xx[i] = b.yy[i] = b.zz[i] = b.mass[i];
        b.xy[i] = b.xz[i] = b.yz[i] = 0.0;
    }
}

BIRM3D_BLOCK_LOOP void add_friction(SlabBlock& b, const SlabCorners& corner, std::size_t first,
                                    std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double nx = corner.law_x[i], ny = corner.law_y[i], yx = corner.dual_x[i], yy = corner.dual_y[i];
        const double rx = corner.arm_x[i], ry = corner.arm_y[i], limit = b.limit[i];
        b.step_x[i] += limit * nx, b.step_y[i] += limit * ny, b.step_z[i] += limit * (rx * ny - ry * nx);
        const double scale = limit / corner.eta[i];
        const double a_xx = scale * (1.0 - nx * yx), a_yy = scale * (1.0 - ny * yy);
        const double a_xy = -0.5 * scale * (nx * yy + ny * yx);
        const double torque_x = a_xy * rx - a_xx * ry, torque_y = a_yy * rx - a_xy * ry;
        b.xx[i] += a_xx, b.xy[i] += a_xy, b.yy[i] += a_yy, b.xz[i] += torque_x, b.yz[i] += torque_y;
        b.zz[i] += torque_y * rx - torque_x * ry;
    }
}

// The inverse of the curvature through its minors, and Newton's step.
BIRM3D_BLOCK_LOOP void end_newton_steps(SlabBlock& s, std::size_t first, std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double xx = s.xx[i], yy = s.yy[i], zz = s.zz[i], xy = s.xy[i], xz = s.xz[i], yz = s.yz[i];
        const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
        const double scale = 1.0 / (xx * a + xy * b + xz * c);
        const double inverse_xx = scale * a, inverse_xy = scale * b, inverse_xz = scale * c,
                     inverse_yy = scale * (xx * zz - xz * xz), inverse_yz = scale * (xy * xz - xx * yz),
                     inverse_zz = scale * (xx * yy - xy * xy);
        s.xx[i] = inverse_xx, s.xy[i] = inverse_xy, s.xz[i] = inverse_xz;
        s.yy[i] = inverse_yy, s.yz[i] = inverse_yz, s.zz[i] = inverse_zz;
        const double x = s.step_x[i], y = s.step_y[i], z = s.step_z[i];
        s.step_x[i] = -(inverse_xx * x + inverse_xy * y + inverse_xz * z);
        s.step_y[i] = -(inverse_xy * x + inverse_yy * y + inverse_yz * z);
        s.step_z[i] = -(inverse_xz * x + (inverse_yz * y + inverse_zz * z));
    }
}

// J mobility K^T of two places of each slab.
BIRM3D_BLOCK_LOOP void respond(const SlabBlock& s, const BlockColumn& arm_x, const BlockColumn& arm_y,
                               const BlockColumn& other_x, const BlockColumn& other_y, std::size_t first,
                               std::size_t end, SlabResponse& to) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double tx = -other_y[i], ty = other_x[i];
        const double xx = s.xx[i] + s.xz[i] * tx, xy = s.xy[i] + s.yz[i] * tx, xz = s.xz[i] + s.zz[i] * tx;
        const double yx = s.xy[i] + s.xz[i] * ty, yy = s.yy[i] + s.yz[i] * ty, yz = s.yz[i] + s.zz[i] * ty;
        to.xx[i] = speed_x(xx, xz, arm_y[i]), to.yx[i] = speed_y(xy, xz, arm_x[i]);
        to.xy[i] = speed_x(yx, yz, arm_y[i]), to.yy[i] = speed_y(yy, yz, arm_x[i]);
    }
}

BIRM3D_BLOCK_LOOP void find_speeds(SlabBlock& s, std::size_t first, std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = s.q_x[i] + s.step_x[i], y = s.q_y[i] + s.step_y[i], z = s.q_z[i] + s.step_z[i];
        s.low.speed_x[i] = speed_x(x, z, s.low.arm_y[i]), s.low.speed_y[i] = speed_y(y, z, s.low.arm_x[i]);
        s.high.speed_x[i] = speed_x(x, z, s.high.arm_y[i]),
        s.high.speed_y[i] = speed_y(y, z, s.high.arm_x[i]);
    }
}

BIRM3D_BLOCK_LOOP void pull(SlabBlock& s, const SlabEnd& at, double sign, std::size_t first,
                            std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = sign * at.pull_x[i], y = sign * at.pull_y[i], z = at.arm_x[i] * y - at.arm_y[i] * x;
        s.step_x[i] += s.xx[i] * x + s.xy[i] * y + s.xz[i] * z;
        s.step_y[i] += s.xy[i] * x + s.yy[i] * y + s.yz[i] * z;
        s.step_z[i] += s.xz[i] * x + (s.yz[i] * y + s.zz[i] * z);
    }
}

BIRM3D_BLOCK_LOOP void find_values(const SlabBlock& s, const SlabCorners& c, double soft, double fraction,
                                   std::size_t first, std::size_t end, BlockColumn& to) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = s.q_x[i] + fraction * s.step_x[i], y = s.q_y[i] + fraction * s.step_y[i],
                     z = s.q_z[i] + fraction * s.step_z[i];
        const double ux = speed_x(x, z, c.arm_y[i]), uy = speed_y(y, z, c.arm_x[i]);
        to[i] = s.limit[i] * rounded(ux, uy, soft * s.reach[i]);
    }
}

BIRM3D_BLOCK_LOOP void find_kinetic(const SlabBlock& s, double fraction, std::size_t first, std::size_t end,
                                    BlockColumn& to) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double x = s.q_x[i] + fraction * s.step_x[i] - s.start_x[i],
                     y = s.q_y[i] + fraction * s.step_y[i] - s.start_y[i],
                     z = s.q_z[i] + fraction * s.step_z[i] - s.start_z[i];
        to[i] = 0.5 * s.mass[i] * (x * x + y * y + z * z);
    }
}

BIRM3D_BLOCK_LOOP void move(SlabBlock& s, double fraction, std::size_t first, std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        s.q_x[i] += fraction * s.step_x[i];
        s.q_y[i] += fraction * s.step_y[i];
        s.q_z[i] += fraction * s.step_z[i];
    }
}

BIRM3D_BLOCK_LOOP void use_law(const SlabBlock& s, SlabCorners& c, double fraction, std::size_t first,
                               std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const bool with_friction = s.limit[i] > 0.0;
        const double per = fraction / c.eta[i];
        const double ux = per * speed_x(s.step_x[i], s.step_z[i], c.arm_y[i]),
                     uy = per * speed_y(s.step_y[i], s.step_z[i], c.arm_x[i]);
        const double nx = c.law_x[i], ny = c.law_y[i], yx = c.dual_x[i], yy = c.dual_y[i];
        const double nu = nx * ux + ny * uy, yu = yx * ux + yy * uy;
        c.used_x[i] = with_friction ? nx + ux - 0.5 * (yx * nu + nx * yu) : 0.0;
        c.used_y[i] = with_friction ? ny + uy - 0.5 * (yy * nu + ny * yu) : 0.0;
        const double x = nx + ux - yx * nu, y = ny + uy - yy * nu, size = std::sqrt(x * x + y * y);
        const double most = 1.0 < size ? size : 1.0;
        c.dual_x[i] = with_friction ? x / most : 0.0;
        c.dual_y[i] = with_friction ? y / most : 0.0;
    }
}

// Displacement of a pin's place in the drift, with the Cayley rotation of drift() in integrate.cpp.
BIRM3D_BLOCK_LOOP void drift_end(const SlabBlock& s, SlabEnd& at, double drift, std::size_t first,
                                 std::size_t end) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = first; i < end; ++i) {
        const double half = 0.5 * drift * (s.q_z[i] / s.gyration[i]),
                     scale = 2.0 * half / (1.0 + half * half);
        at.drift_x[i] = drift * s.q_x[i] + scale * (-at.place_y[i] - half * at.place_x[i]);
        at.drift_y[i] = drift * s.q_y[i] + scale * (at.place_x[i] - half * at.place_y[i]);
        at.speed_x[i] = speed_x(s.q_x[i], s.q_z[i], at.arm_y[i]);
        at.speed_y[i] = speed_y(s.q_y[i], s.q_z[i], at.arm_x[i]);
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
    SlabBlock& b = slabs.block;
    respond(b, b.low.arm_x, b.low.arm_y, b.low.arm_x, b.low.arm_y, slabs.first, slabs.end, b.at_low);
    respond(b, b.high.arm_x, b.high.arm_y, b.high.arm_x, b.high.arm_y, slabs.first, slabs.end, b.at_high);
    respond(b, b.low.arm_x, b.low.arm_y, b.high.arm_x, b.high.arm_y, slabs.first, slabs.end, b.across);
    find_speeds(b, slabs.first, slabs.end);
}

void add_pulls(const SlabRange& slabs) {
    pull(slabs.block, slabs.block.low, -1.0, slabs.first, slabs.end);
    pull(slabs.block, slabs.block.high, 1.0, slabs.first, slabs.end);
}

// Sums are in the order of the slabs.
double add_value(const SlabRange& slabs, double soft, double fraction, double sum) {
    const SlabBlock& b = slabs.block;
    BlockColumn kinetic;
    std::array<BlockColumn, 4> corner_loss;
    find_kinetic(b, fraction, slabs.first, slabs.end, kinetic);
    for (std::size_t c = 0; c < corner_loss.size(); ++c)
        find_values(b, b.corners[c], soft, fraction, slabs.first, slabs.end, corner_loss[c]);
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
    SlabBlock& b = slabs.block;
    for (std::size_t i = slabs.first; i < slabs.end; ++i)
        b.q_x[i] = b.start_x[i], b.q_y[i] = b.start_y[i], b.q_z[i] = b.start_z[i];
}

void find_drifts(const SlabRange& slabs, double drift) {
    for (SlabEnd* at : {&slabs.block.low, &slabs.block.high})
        drift_end(slabs.block, *at, drift, slabs.first, slabs.end);
}

}  // namespace birm3d
