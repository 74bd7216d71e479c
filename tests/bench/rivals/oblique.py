"""The answer of W3: BIRM3D at its finest, confirmed by an integrator that shares nothing with it.

DOP853 of scipy to a relative tolerance of 1e-10, restarted at every event of every node: it touches,
passes the knee, turns from loading to unloading and back, is released. Places of held nodes are part of the
state: a held node moves along the present normal of the wall, in body axes p' = n (x' - n' . p), n' = -w
x n, where x is the distance of the mass centre past the wall.
"""

from __future__ import annotations

import dataclasses
import enum
import math
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.integrate import DOP853
from scipy.optimize import brentq

from .definition import COMPARED, Case, block, compared, heading
from .ours import simulation

Floats = npt.NDArray[np.float64]
FINEST = {"tolerance": 1e-8, "output_interval": 1e-5}


class Mode(enum.IntEnum):
    FREE = 0
    LOADING = 1  # on the envelope, below the knee
    HARDENING = 2
    UNLOADING = 3  # and loading again, on its line


def with_answer(case: Case, n: int) -> Case:
    """The case with the answer of BIRM3D at its finest."""
    return dataclasses.replace(case, exact=compared(simulation(case, n, **FINEST).run()))


class Crash:
    """Right-hand side and guards; the state is place, velocity, quaternion, angular momentum, nodes."""

    def __init__(self, case: Case, n: int) -> None:
        body = self.body = block(case, n)
        self.mu, self.n = case.friction, n
        self.inertia = np.array(body.inertia)
        self.length = np.linalg.norm(body.nodes - body.anchors, axis=1)
        self.mode = np.full(n, Mode.FREE)
        self.residual = np.zeros(n)
        self.most = np.zeros(n)  # deflection at which the unloading line meets the envelope
        yaw = math.radians(90.0 - case.angle)
        angle = math.radians(case.angle)
        self.start = np.concatenate(
            [
                [float((body.nodes @ heading(case)).min()), 0.0, 0.0],
                [case.speed * math.sin(angle), case.speed * math.cos(angle), 0.0],
                [math.cos(0.5 * yaw), 0.0, 0.0, math.sin(0.5 * yaw)],
                np.zeros(3),
                body.nodes.ravel(),
            ]
        )

    def seen(self, y: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """Rotation, spin (body axes), nodes, normal (body axes) and gaps."""
        w, i, j, k = y[6:10] / np.linalg.norm(y[6:10])
        rotation = np.array(
            [
                [1 - 2 * (j * j + k * k), 2 * (i * j - w * k), 2 * (i * k + w * j)],
                [2 * (i * j + w * k), 1 - 2 * (i * i + k * k), 2 * (j * k - w * i)],
                [2 * (i * k - w * j), 2 * (j * k + w * i), 1 - 2 * (i * i + j * j)],
            ]
        )
        spin = (rotation.T @ y[10:13]) / self.inertia
        nodes = y[13:].reshape(-1, 3)
        normal = -rotation[0]
        return rotation, spin, nodes, normal, nodes @ normal - y[0]

    def forces(self, nodes: Floats) -> tuple[Floats, Floats, Floats]:
        """Deflections, truss forces and their directions b."""
        arms = nodes - self.body.anchors
        size = np.linalg.norm(arms, axis=1)
        d = self.length - size
        body, mode = self.body, self.mode
        hinge = np.where(mode == Mode.HARDENING, d - body.knee, 0.0)
        envelope = body.k_initial * d + (body.k_hardening - body.k_initial) * hinge
        force = np.where(mode == Mode.UNLOADING, body.k_unloading * (d - self.residual), envelope)
        return d, np.where(mode == Mode.FREE, 0.0, force), arms / size[:, None]

    def ways(self, y: Floats) -> tuple[Floats, Floats]:
        """Speeds of held nodes along the normal, and the normal."""
        _, spin, nodes, normal, _ = self.seen(y)
        return y[3] + nodes @ np.cross(spin, normal), normal

    def __call__(self, t: float, y: Floats) -> Floats:
        rotation, spin, nodes, normal, _ = self.seen(y)
        _, force, direction = self.forces(nodes)
        pressure = -force * (direction @ normal)
        slip = rotation.T @ y[3:6] + np.cross(spin, nodes)
        slip -= np.outer(slip @ normal, normal)
        speed = np.linalg.norm(slip, axis=1)
        push = pressure[:, None] * (normal - self.mu * slip / speed[:, None])
        w, v = y[6], y[7:10]
        held = np.where(self.mode == Mode.FREE, 0.0, self.ways(y)[0])
        return np.concatenate(
            [
                y[3:6],
                rotation @ push.sum(axis=0) / self.body.mass,
                [-0.5 * float(v @ spin)],
                0.5 * (w * spin + np.cross(v, spin)),
                rotation @ np.cross(nodes, push).sum(axis=0),
                np.outer(held, normal).ravel(),
            ]
        )

    def wall_force(self, y: Floats) -> float:
        _, _, nodes, normal, _ = self.seen(y)
        _, force, direction = self.forces(nodes)
        return float(-(force * (direction @ normal)).sum())

    def guards(self, y: Floats) -> Floats:
        """Two of each node, (2, n): one of them below zero asks for another mode."""
        _, _, nodes, _, gap = self.seen(y)
        d, force, direction = self.forces(nodes)
        speeds, normal = self.ways(y)
        rising = -(direction @ normal) * speeds  # rate of the deflection
        free = np.full(self.n, np.inf)
        mode = self.mode
        first = np.select(
            [mode == Mode.FREE, mode == Mode.UNLOADING], [gap, force / self.body.k_unloading], rising
        )
        second = np.select(
            [mode == Mode.LOADING, mode == Mode.UNLOADING], [self.body.knee - d, self.most - d], free
        )
        return np.array([first, second])

    def switch(self, y: Floats, asked: npt.NDArray[np.bool_]) -> None:
        d, force, _ = self.forces(self.seen(y)[2])
        for which, i in zip(*np.nonzero(asked), strict=True):
            mode = self.mode[i]
            if mode == Mode.FREE:
                self.mode[i] = Mode.UNLOADING if self.residual[i] > 0.0 else Mode.LOADING
            elif mode == Mode.UNLOADING:
                beyond = d[i] > self.body.knee
                self.mode[i] = Mode.FREE if which == 0 else Mode.HARDENING if beyond else Mode.LOADING
            elif which == 1:
                self.mode[i] = Mode.HARDENING
            else:
                self.most[i] = d[i]
                self.residual[i] = d[i] - force[i] / self.body.k_unloading
                self.mode[i] = Mode.UNLOADING


def independent(case: Case, n: int, rtol: float = 1e-10) -> dict[str, float]:
    """Crush, peak force and speed of a case by DOP853 with events."""
    if case.duration is None:
        raise ValueError(f"{case.name} must have a duration")
    crash = Crash(case, n)
    t, y = 0.0, crash.start
    crush = peak = 0.0
    while t < case.duration:
        # Whatever is below zero from the start is below by rounding and goes on: an event is a way down.
        before = crash.guards(y)
        solver = DOP853(crash, t, y, case.duration, rtol=rtol, atol=1e-12, max_step=5e-4)
        while solver.status == "running":
            solver.step()
            after = crash.guards(solver.y)
            course = solver.dense_output()
            down = (after < 0.0) & (before > ROUNDING)
            down |= (after < -ROUNDING) & (before <= ROUNDING)
            end = solver.t
            for which, i in zip(*np.nonzero(down), strict=True):
                if before[which, i] <= ROUNDING:
                    end = min(end, solver.t_old)
                    continue

                def guard(at: float, which: int = which, i: int = i, course: Any = course) -> float:
                    return float(crash.guards(course(at))[which, i])

                if guard(end) < 0.0:
                    end = brentq(guard, solver.t_old, end, xtol=1e-15, rtol=1e-14)
            for at in np.linspace(solver.t_old, end, 20):
                peak = max(peak, crash.wall_force(course(at)))
            t, y = end, course(end) if down.any() else solver.y
            crush = max(crush, float(crash.forces(crash.seen(y)[2])[0].max()))
            if down.any():
                crash.switch(y, down & (crash.guards(y) <= ROUNDING))
                break
            before = after
    return dict(zip(COMPARED, (crush, peak, float(np.hypot(*y[3:5]))), strict=True))


# Guards are metres and metres per second; this far below zero is rounding.
ROUNDING = 1e-11
