"""What all rivals compute: the body, the loads W1 to W3, the exact answers, and what an answer is.

A body of 6,804 kg, inertia (5,000, 40,000, 42,000) kg m^2, no gravity, no tyres, 22.352 m/s along the
wall's normal; n equal trusses on a flat front face of 2.4 m by 1.6 m, 3 m ahead of the mass centre, which
touches at t = 0. Stiffness is shared equally, so that the answer of W1 and W2 does not depend on n.

W1: elastic, 3 MN/m. W2: 3 MN/m to 0.4 m, then 6, unloading 60 MN/m. W3: W2 at 25 degrees to the wall with
a friction coefficient of 0.2, free to turn, for 0.2 s; its trusses, 2 m long, lie along the wall's normal
at the first touch, not along the body's axis: those would be slanted by 65 degrees, and it would be the
rigid body that the wall stops.

A run of W1 and W2 ends where the wall force has ended and the body moves away. Errors are the greatest
relative one of crush, peak force and rebound speed. W3 has no closed form: its answer is that of BIRM3D
at the finest tolerance, which an independent integrator confirms (oblique.py).
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import numpy.typing as npt
from bench_birm3d import COMPARED, LAW, MASS, SPEED, exact_crush, worst_error
from birm3d import Result, Vehicle, scenes
from numpy_reference import Answer, Block

__all__ = [
    *("CASES", "COMPARED", "MASS", "SPEED", "AbsentError", "Answer", "Case", "Rival", "Run"),
    *("compared", "vehicle"),
]

NODES = (100, 316, 1000, 3162, 10000)
TARGETS = (0.01, 1e-3, 1e-4)
TRUSS = 2.0  # m, length
# Steps from coarse to fine, three an octave [s].
STEPS = tuple(32e-3 * 2.0 ** (-i / 3.0) for i in range(31))


class AbsentError(Exception):
    """What a rival needs is not there; the message says what."""


class RefusedError(Exception):
    """A rival refuses a setting."""


@dataclass(frozen=True)
class Case:
    name: str
    law: Mapping[str, float]  # of all trusses together, N/m and m
    angle: float = 90.0  # deg, between path and wall
    friction: float = 0.0
    duration: float | None = None  # s; None: until the body has left
    speed: float = SPEED  # m/s
    mass: float = MASS  # kg
    exact: Mapping[str, float] = field(default_factory=dict)

    def error(self, answer: Answer) -> tuple[float, str]:
        """Greatest relative error, and of what."""
        return worst_error({name: getattr(answer, name) for name in COMPARED}, self.exact)


ELASTIC = {"k_initial": 3e6, "knee": 0.4, "k_hardening": 3e6, "k_unloading": 3e6}
W1 = Case("W1", ELASTIC, exact=exact_crush(ELASTIC))
W2 = Case("W2", LAW, exact=exact_crush(LAW))
W3 = Case("W3", LAW, angle=25.0, friction=0.2, duration=0.2)
CASES = {"W1": W1, "W2": W2, "W3": W3}


# Takes a setting (a step in seconds or a tolerance), steps until the body has left, and tells.
Run = Callable[[float], Answer]


class Rival(Protocol):
    name: str
    setup: str  # one sentence: its best honest set-up
    does_more: str  # what it does that we do not
    settings: Sequence[float]  # from coarse to fine
    wrong: Mapping[str, str]  # case -> why its physics is not that of the case

    def build(self, case: Case, n: int) -> Run:
        """Build the scene; not timed. Raises AbsentError."""
        ...


def compared(result: Result) -> dict[str, float]:
    """Return what is compared; the speed is that at the end: a block that turns may not have left."""
    speed = float(np.hypot(*result.velocity[-1, :2]))
    return {name: speed if name == "exit_speed" else result.metrics[name] for name in COMPARED}


def vehicle(case: Case, n: int) -> Vehicle:
    body = scenes.laboratory_block(n, **case.law).with_gvw(case.mass)
    if case.angle == 90.0:
        return body
    each = {name: value if name == "knee" else value / n for name, value in case.law.items()}
    return Vehicle.from_arrays(
        name="laboratory_block",
        mass=body.mass,
        inertia=body.inertia,
        nodes=body.nodes,
        anchors=body.nodes + TRUSS * heading(case),
        **each,
    )


def block(case: Case, n: int) -> Block:
    """The body of a case for rivals, stiffness of one truss."""
    body = _usual(n)
    anchors = body.anchors if case.angle == 90.0 else body.nodes + TRUSS * heading(case)
    each = {name: value if name == "knee" else value / n for name, value in case.law.items()}
    x, y, z = (np.diag(body.inertia) * (case.mass / body.mass)).tolist()
    return Block(mass=case.mass, inertia=(x, y, z), nodes=body.nodes, anchors=anchors, **each)


@functools.lru_cache
def _usual(n: int) -> Vehicle:
    """Geometry for rivals, which must not pay for ours in a batch."""
    return scenes.laboratory_block(n, **LAW)


def heading(case: Case) -> npt.NDArray[np.float64]:
    """Outward normal of the wall in the axes of the body at t = 0, (3,)."""
    angle = math.radians(case.angle)
    return np.array([-math.sin(angle), math.cos(angle), 0.0])
