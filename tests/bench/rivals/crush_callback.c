/* Our law as a passive force of MuJoCo: written for gcc or clang to vectorise, columns of doubles, one pass.
 *
 * A free body (body 1, axes at its mass centre) and a wall n . p <= 0 with n = (-1, 0, 0), world. Nodes that
 * have come into the wall are held on it, along its normal; the force of a truss is
 * min(envelope(d), k_unloading (d - residual)), projected on the normal; friction against the sliding.
 * The memory (places, residuals, forces) is taken on only with a state that is accepted: of Runge-Kutta's
 * stages the first.
 *
 * `drive` steps until the wall force has ended and the body moves away, or for the steps given.
 */
#include <math.h>
#include <mujoco/mujoco.h>

typedef struct {
    int n, first, left;
    double *x, *y, *z;    /* nodes, body axes (m) */
    double *ax, *ay, *az; /* anchors */
    double *length, *residual, *force, *deflection;
    double k_initial, knee, k_hardening, k_unloading, mu;
    double peak, peak_force; /* greatest deflection (m) and sum of pressures (N) of accepted states */
} Crush;

static Crush* now;

typedef struct {
    double force, mx, my, mz, peak, released;
    double fx, fy, fz, tx, ty, tz; /* friction */
} Sums;

typedef struct {
    double nx, ny, nz, offset;     /* wall */
    double vx, vy, vz, wx, wy, wz; /* of the body */
} Pose;

/* clang-format off: it would break the pragma. */
/* One pass over the nodes, body axes: sums of F (-b . n) and of it times the place of the node; friction. KEEP takes
 * on the state, RUB has friction: four loops from one text, so that each is vectorised without what it does not need. */
#define PRESS(NAME, KEEP, RUB)                                                                             \
    static Sums NAME(const Crush* c, const Pose* at) {                                                     \
        const int n = c->n;                                                                                \
        double* restrict X = c->x, * restrict Y = c->y, * restrict Z = c->z;                               \
        const double* restrict ax = c->ax, * restrict ay = c->ay, * restrict az = c->az;                   \
        const double* restrict length = c->length;                                                         \
        double* restrict residual = c->residual, * restrict last = c->force;                               \
        double* restrict deflection = c->deflection;                                                       \
        const double k1 = c->k_initial, more = c->k_hardening - c->k_initial, knee = c->knee;              \
        const double ku = c->k_unloading, per_ku = 1.0 / ku, mu = c->mu;                                   \
        const double nx = at->nx, ny = at->ny, nz = at->nz, offset = at->offset;                           \
        const double vx = at->vx, vy = at->vy, vz = at->vz, wx = at->wx, wy = at->wy, wz = at->wz;         \
        double force = 0, mx = 0, my = 0, mz = 0, peak = 0, released = 0;                                  \
        double fx = 0, fy = 0, fz = 0, tx = 0, ty = 0, tz = 0;                                             \
        _Pragma("omp simd reduction(+:force,mx,my,mz,released,fx,fy,fz,tx,ty,tz) reduction(max:peak)") \
        for (int i = 0; i < n; ++i) {                                                         \
            const double gap = nx * X[i] + ny * Y[i] + nz * Z[i] - offset;                                 \
            const double held = gap < 0.0 || last[i] > 0.0 ? 1.0 : 0.0;                                    \
            const double way = held * gap;                                                                 \
            const double x = X[i] - way * nx, y = Y[i] - way * ny, z = Z[i] - way * nz;                    \
            const double bx = x - ax[i], by = y - ay[i], bz = z - az[i];                                   \
            const double size = sqrt(bx * bx + by * by + bz * bz);                                         \
            const double d = length[i] - size;                                                             \
            const double over = d - knee;                                                                  \
            const double envelope = k1 * d + more * (over > 0.0 ? over : 0.0);                             \
            const double line = ku * (d - residual[i]);                                                    \
            const double least = envelope < line ? envelope : line;                                        \
            const double f = held * (least > 0.0 ? least : 0.0);                                           \
            const double out = -(nx * bx + ny * by + nz * bz);                                             \
            const double p = f * (out > 0.0 ? out : 0.0) / size;                                           \
            force += p, mx += p * x, my += p * y, mz += p * z;                                             \
            if (RUB) {                                                                                     \
                const double ux = vx + wy * z - wz * y, uy = vy + wz * x - wx * z,                         \
                             uz = vz + wx * y - wy * x;                                                    \
                const double un = ux * nx + uy * ny + uz * nz;                                             \
                const double sx = ux - un * nx, sy = uy - un * ny, sz = uz - un * nz;                      \
                const double speed = sqrt(sx * sx + sy * sy + sz * sz);                                    \
                const double per = -mu * p / (speed > 1e-9 ? speed : 1e-9);                                \
                const double gx = per * sx, gy = per * sy, gz = per * sz;                                  \
                fx += gx, fy += gy, fz += gz;                                                              \
                tx += y * gz - z * gy, ty += z * gx - x * gz, tz += x * gy - y * gx;                       \
            }                                                                                              \
            if (KEEP) {                                                                                    \
                const double rest = held * (d - envelope * per_ku);                                        \
                residual[i] = rest > residual[i] ? rest : residual[i];                                     \
                const double most = held * d;                                                              \
                peak = most > peak ? most : peak;                                                          \
                released += f == 0.0 && last[i] > 0.0 && gap > 0.0 ? 1.0 : 0.0;                            \
                X[i] = x, Y[i] = y, Z[i] = z;                                                              \
                deflection[i] = d;                                                                         \
                last[i] = f;                                                                               \
            }                                                                                              \
        }                                                                                                  \
        return (Sums){force, mx, my, mz, peak, released, fx, fy, fz, tx, ty, tz};                          \
    }

PRESS(press_trial, 0, 0)
PRESS(press_accepted, 1, 0)
PRESS(rub_trial, 0, 1)
PRESS(rub_accepted, 1, 1)
/* clang-format on */

/* Few nodes a step let go: they stay at the residual length of their truss, along the truss. */
static void release(const Crush* c) {
    for (int i = 0; i < c->n; ++i) {
        if (c->force[i] > 0.0 || !(c->deflection[i] < c->residual[i])) continue;
        const double bx = c->x[i] - c->ax[i], by = c->y[i] - c->ay[i], bz = c->z[i] - c->az[i];
        const double scale = (c->length[i] - c->residual[i]) / sqrt(bx * bx + by * by + bz * bz);
        c->x[i] = c->ax[i] + scale * bx, c->y[i] = c->ay[i] + scale * by, c->z[i] = c->az[i] + scale * bz;
        c->deflection[i] = c->residual[i];
    }
}

static void passive(const mjModel* m, mjData* d) {
    Crush* c = now;
    const mjtNum* R = d->xmat + 9; /* of body 1, by rows, body to world */
    Pose at = {-R[0], -R[1], -R[2], d->xpos[3], 0, 0, 0, d->qvel[3], d->qvel[4], d->qvel[5]};
    at.vx = R[0] * d->qvel[0] + R[3] * d->qvel[1] + R[6] * d->qvel[2];
    at.vy = R[1] * d->qvel[0] + R[4] * d->qvel[1] + R[7] * d->qvel[2];
    at.vz = R[2] * d->qvel[0] + R[5] * d->qvel[1] + R[8] * d->qvel[2];
    const Sums s = c->first ? (c->mu > 0.0 ? rub_accepted : press_accepted)(c, &at)
                            : (c->mu > 0.0 ? rub_trial : press_trial)(c, &at);
    if (c->first) {
        if (s.released > 0.0) release(c);
        c->peak = s.peak > c->peak ? s.peak : c->peak;
        c->peak_force = s.force > c->peak_force ? s.force : c->peak_force;
        c->left = s.force == 0.0 && d->qvel[0] < 0.0;
    }
    c->first = 0;
    const double f[3] = {s.force * at.nx + s.fx, s.force * at.ny + s.fy, s.force * at.nz + s.fz};
    for (int k = 0; k < 3; ++k)
        d->qfrc_passive[k] += R[3 * k] * f[0] + R[3 * k + 1] * f[1] + R[3 * k + 2] * f[2];
    d->qfrc_passive[3] += s.my * at.nz - s.mz * at.ny + s.tx;
    d->qfrc_passive[4] += s.mz * at.nx - s.mx * at.nz + s.ty;
    d->qfrc_passive[5] += s.mx * at.ny - s.my * at.nx + s.tz;
    (void)m;
}

/* Returns the steps taken; at most `most`. With `whole`, all of them. */
int drive(Crush* c, const mjModel* m, mjData* d, void (*step)(const mjModel*, mjData*), mjfGeneric* callback,
          int most, int whole) {
    int steps = 0;
    now = c;
    *callback = passive;
    c->left = 0;
    while (steps < most) {
        c->first = 1;
        step(m, d);
        ++steps;
        if (c->left && !whole) break;
    }
    *callback = 0;
    now = 0;
    return steps;
}
