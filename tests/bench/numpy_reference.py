"""The law of BIRM3D in NumPy, written as an expert would: the rival of the benchmark.

Nodes are columns of (3, n) arrays that are allocated once; every operation writes in place; nothing in a step
is done node by node in Python, and the few numbers of the body itself are plain floats, not small arrays.
Same physics, by leapfrog (kick, drift, kick) with a fixed step: a body that turns, nodes held on a plane,
the three-segment truss law with unloading and release, the truss force projected on the normal, its torque,
Coulomb friction where there is any, the energy balance of the trusses.

Left out, in NumPy's favour: tyres and ground, bottomed-out trusses, the error estimate and the stability
bound, the broad phase, the histories (it keeps one number a step, the wall force), and the 20 ms that BIRM3D
runs on after the vehicle has left. The `lean` rival also leaves out rotation and energy balance: a
program for W2 alone.

Two differences. A held node moves along the present normal only; BIRM3D takes the mean of the old and the new
one, which tells where the body turns fast. One number holds a truss's history, its residual deflection r: as
no slope of the envelope is above k_unloading, the force is min(envelope(d), k_unloading (d - r)), and r grows
where the envelope is less.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Quaternion = tuple[float, float, float, float]  # w, x, y, z


@dataclass(frozen=True)
class Block:
    """A body with equal trusses; stiffnesses of one truss [N/m]."""

    mass: float  # kg
    inertia: tuple[float, float, float]  # principal, body axes [kg m^2]
    nodes: Floats  # (n, 3), body axes [m]
    anchors: Floats  # (n, 3) [m]
    k_initial: float
    knee: float
    k_hardening: float
    k_unloading: float


@dataclass(frozen=True)
class Answer:
    dynamic_crush: float  # m
    peak_normal_force: float  # N
    exit_speed: float  # m/s
    steps: int
    run_time: float  # s, stepping only


class Run:
    """A run into the plane x = 0; :meth:`run` may be called again and again.

    `angle` [deg] between path and plane, nose ahead. `duration` [s]; None: until the body has left.
    """

    def __init__(
        self,
        block: Block,
        speed: float,
        time_step: float,
        *,
        lean: bool = False,
        angle: float = 90.0,
        friction: float = 0.0,
        duration: float | None = None,
    ) -> None:
        if lean and (friction > 0.0 or angle != 90.0):
            raise ValueError(f"lean is head-on and without friction, got {angle} deg and {friction}")
        self.block = block
        self.speed = speed
        self.time_step = time_step
        self.lean = lean
        self.angle = math.radians(angle)
        self.friction = friction
        self.steps = math.ceil((1.0 if duration is None else duration) / time_step - 1e-9)
        self.whole = duration is not None
        n = len(block.nodes)
        # Everything a step touches.
        self.node = np.empty((3, n))
        self.arm = np.empty((3, n))
        self.move = np.empty((3, n))
        self.anchor = np.ascontiguousarray(block.anchors.T)
        self.length = np.linalg.norm(block.nodes - block.anchors, axis=1)
        self.residual = np.empty(n)
        self.peak = np.empty(n)
        self.gap, self.size, self.envelope, self.line = np.empty((4, n))
        self.deflection, self.last_deflection = np.empty((2, n))
        self.force, self.last_force = np.empty((2, n))
        self.pushing, self.inside, self.released = np.empty((3, n), bool)

    def start(self) -> None:
        """Uncrush all trusses."""
        self.node[:] = self.block.nodes.T
        for column in (self.residual, self.peak, self.last_force, self.last_deflection):
            column.fill(0.0)
        self.pushing.fill(False)

    def run(self) -> Answer:
        block, dt, lean = self.block, self.time_step, self.lean
        self.start()
        node = self.node
        mass = block.mass
        aim = math.sin(self.angle), math.cos(self.angle)
        velocity = [self.speed * aim[0], self.speed * aim[1], 0.0]
        yaw = 0.5 * (0.5 * math.pi - self.angle)
        turn = (math.cos(yaw), 0.0, 0.0, math.sin(yaw))
        axes = rotation(turn)
        position = [-float(np.dot(axes[:3], node).max()), 0.0, 0.0]
        momentum = [0.0, 0.0, 0.0]  # angular, world axes
        force, torque = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        forces = np.empty(self.steps)
        balances = np.empty((self.steps, 3))
        work, steps = 0.0, 0
        self.last_push = force

        start = time.perf_counter()
        while steps < self.steps:
            kick = 0.5 * dt / mass
            velocity[0] += kick * force[0]
            velocity[1] += kick * force[1]
            velocity[2] += kick * force[2]
            position[0] += dt * velocity[0]
            position[1] += dt * velocity[1]
            position[2] += dt * velocity[2]
            if not lean:
                momentum = [p + 0.5 * dt * t for p, t in zip(momentum, torque, strict=True)]
                turn = drift(turn, momentum, block.inertia, dt)
                axes = rotation(turn)
            # The plane n . p <= 0 with n = (-1, 0, 0), seen from the body.
            normal = np.array((-axes[0], -axes[1], -axes[2]))
            pressure, moment = self.press(normal, position[0])
            force = (-pressure, 0.0, 0.0)
            turning = np.cross(moment, normal).tolist()
            if self.friction > 0.0 and pressure > 0.0:
                # At the end of the step, as the last force would have it.
                ahead = [v + kick * f for v, f in zip(velocity, self.last_push, strict=True)]
                spin = [p + 0.5 * dt * t for p, t in zip(momentum, torque, strict=True)]
                rub, rub_moment = self._friction(normal, seen(axes, ahead), seen(axes, spin))
                force = tuple(f + r for f, r in zip(force, turned(axes, rub), strict=True))
                turning = [t + r for t, r in zip(turning, rub_moment, strict=True)]
            self.last_push = force
            velocity[0] += kick * force[0]
            velocity[1] += kick * force[1]
            velocity[2] += kick * force[2]
            if not lean:
                torque = turned(axes, turning)
                momentum = [p + 0.5 * dt * t for p, t in zip(momentum, torque, strict=True)]
                work += self._work()
                balances[steps] = (
                    0.5 * mass * (velocity[0] ** 2 + velocity[1] ** 2 + velocity[2] ** 2),
                    0.5 / block.k_unloading * float(np.dot(self.last_force, self.last_force)),
                    work,
                )
            forces[steps] = pressure
            steps += 1
            if pressure == 0.0 and velocity[0] < 0.0 and not self.whole:
                break
        run_time = time.perf_counter() - start
        speed = math.hypot(velocity[0], velocity[1])
        return Answer(float(self.peak.max()), float(forces[:steps].max()), speed, steps, run_time)

    def press(self, normal: Floats, offset: float) -> tuple[float, Floats]:
        """Hold the nodes on the plane normal . p = offset; return the sums of p and p r over the nodes."""
        block, node, arm, move = self.block, self.node, self.arm, self.move
        gap, size, d, envelope, line = self.gap, self.size, self.deflection, self.envelope, self.line
        pushing, inside, released, force = self.pushing, self.inside, self.released, self.force

        np.dot(normal, node, out=gap)
        gap -= offset
        np.less(gap, 0.0, out=inside)
        inside |= pushing  # held: arrives or is already there
        np.multiply(gap, inside, out=line)
        np.multiply(normal[:, None], line, out=move)
        node -= move

        np.subtract(node, self.anchor, out=arm)
        np.einsum("in,in->n", arm, arm, out=size)
        np.sqrt(size, out=size)
        np.subtract(self.length, size, out=d)

        # Fig. 3: envelope, then the unloading line wherever it is lower.
        np.subtract(d, block.knee, out=envelope)
        np.maximum(envelope, 0.0, out=envelope)
        envelope *= block.k_hardening - block.k_initial
        np.multiply(d, block.k_initial, out=line)
        envelope += line
        np.subtract(d, self.residual, out=line)
        line *= block.k_unloading
        np.minimum(envelope, line, out=force)
        np.maximum(force, 0.0, out=force)
        force *= inside
        np.multiply(envelope, -1.0 / block.k_unloading, out=envelope)
        envelope += d
        np.maximum(self.residual, envelope, out=self.residual, where=inside)
        np.maximum(self.peak, d, out=self.peak, where=inside)

        # A node whose truss no longer presses stays where that happened; few steps have one.
        np.equal(force, 0.0, out=released)
        released &= pushing
        if released.any():
            back = np.flatnonzero(released & (gap > 0.0))
            last = self.last_deflection[back]
            share = np.clip((last - self.residual[back]) / np.maximum(last - d[back], 1e-300), 0.0, 1.0)
            node[:, back] += (1.0 - share) * move[:, back]
            d[back] = last - share * (last - d[back])
        np.greater(force, 0.0, out=pushing)

        # Pressure F (-b . n), b = B / |B|.
        np.dot(normal, arm, out=envelope)
        np.negative(envelope, out=envelope)
        np.maximum(envelope, 0.0, out=envelope)
        envelope *= force
        envelope /= size
        if self.lean:
            self.last_deflection, self.deflection = d, self.last_deflection
        return float(envelope.sum()), node @ envelope

    def _friction(
        self, normal: Floats, velocity: list[float], momentum: list[float]
    ) -> tuple[list[float], list[float]]:
        """Force and moment against the sliding of the nodes that :meth:`press` just pressed; body axes."""
        slip, node, size = self.move, self.node, self.size
        spin = np.array([p / i for p, i in zip(momentum, self.block.inertia, strict=True)])
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            np.multiply(node[j], spin[i], out=slip[k])
            np.multiply(node[i], spin[j], out=size)
            slip[k] -= size
            slip[k] += velocity[k]
        np.dot(normal, slip, out=size)
        for k in range(3):
            np.multiply(size, normal[k], out=self.line)
            slip[k] -= self.line
        np.einsum("in,in->n", slip, slip, out=size)
        np.sqrt(size, out=size)
        np.maximum(size, 1e-9, out=size)
        np.divide(self.envelope, size, out=size)
        size *= -self.friction
        slip *= size
        return slip.sum(axis=1).tolist(), np.cross(node, slip, axis=0).sum(axis=1).tolist()

    def _work(self) -> float:
        """Work done on the trusses in the last step, trapezoid rule [J]; turns over the columns."""
        line = self.line
        np.subtract(self.deflection, self.last_deflection, out=line)
        line *= self.inside
        self.last_force += self.force
        work = 0.5 * float(np.dot(self.last_force, line))
        np.logical_not(self.inside, out=self.released)
        np.copyto(self.deflection, self.last_deflection, where=self.released)
        self.force, self.last_force = self.last_force, self.force
        self.deflection, self.last_deflection = self.last_deflection, self.deflection
        return work


def rotation(q: Quaternion) -> tuple[float, ...]:
    """Rows of the rotation matrix, body to world."""
    w, x, y, z = q
    return (
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
        2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
        2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y),
    )  # fmt: skip


def turned(m: tuple[float, ...], v: list[float]) -> tuple[float, float, float]:
    """Body axes to world axes."""
    x, y, z = v
    return (m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z)


def seen(m: tuple[float, ...], v: list[float]) -> list[float]:
    """World axes to body axes."""
    x, y, z = v
    return [m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z]


def drift(q: Quaternion, momentum: list[float], inertia: tuple[float, float, float], dt: float) -> Quaternion:
    """Turn by the implicit midpoint rule; the angular momentum stands still in the world."""
    x, y, z = momentum
    size = abs(x) + abs(y) + abs(z)
    if size == 0.0:
        return q
    m = rotation(q)
    start = (m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z)
    end, new = start, q
    for _ in range(100):
        a, b, c = (0.25 * dt * (s + e) / i for s, e, i in zip(start, end, inertia, strict=True))
        scale = 1.0 / math.sqrt(1.0 + a * a + b * b + c * c)
        w0, x0, y0, z0 = q
        new = (
            scale * (w0 - x0 * a - y0 * b - z0 * c),
            scale * (x0 + w0 * a + y0 * c - z0 * b),
            scale * (y0 + w0 * b + z0 * a - x0 * c),
            scale * (z0 + w0 * c + x0 * b - y0 * a),
        )
        m = rotation(new)
        old = end
        end = (m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z)
        if max(abs(e - o) for e, o in zip(end, old, strict=True)) <= 1e-15 * size:
            break
    return new
