"""OpenSeesPy on one dimension: a mass, n parallel zero-length springs, explicit integration.

Hysteretic: three slopes of the envelope, unloading on the first one. With a first slope of k_unloading
over a micrometre, then k_initial to the knee and k_hardening, that is W2 to 1e-5; loaded to a force of
nil it ends. No contact, no turning: W1 and W2 with a flat face only.
"""

from __future__ import annotations

import ctypes
import importlib.util
import os
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .definition import STEPS, AbsentError, Answer, Case, Run, block

FIRST = 1e-6  # m


def load_libraries() -> None:
    """Load those that its Linux package brings along, in a folder where the loader does not look."""
    package = importlib.util.find_spec("openseespylinux")
    if package is None or package.origin is None:
        return
    for name in ("libgfortran.so.4", "libblas.so.3", "liblapack.so.3"):  # each needs those before it
        library = Path(package.origin).parent / "lib" / name
        if library.exists():
            ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)


def engine() -> Any:
    try:
        load_libraries()
        import openseespy.opensees as opensees
    except (ImportError, OSError, RuntimeError) as error:
        raise AbsentError(f"openseespy is not installed or its libraries are missing ({error})") from None
    return opensees


class ZeroLength:
    does_more = "hysteretic laws by the hundred, frames, implicit solvers; the wall is one coordinate here"
    settings = STEPS
    wrong: Mapping[str, str] = {"W3": "it has no body that turns before a wall"}

    def __init__(self, integrator: str, *arguments: float) -> None:
        self.name = f"OpenSeesPy, zero-length springs, {integrator}"
        self.setup = f"one coordinate, {integrator}, diagonal mass, no recorders"
        self.integrator = (integrator, *arguments)

    def build(self, case: Case, n: int) -> Run:
        ops = engine()
        body = block(case, n)
        elastic = body.k_initial == body.k_hardening == body.k_unloading

        def build() -> None:
            ops.wipe()
            ops.logFile(os.devnull, "-noEcho")
            ops.model("basic", "-ndm", 1, "-ndf", 1)
            ops.node(1, 0.0)
            ops.node(2, 0.0)
            ops.fix(1, 1)
            ops.mass(2, body.mass)
            if elastic:
                ops.uniaxialMaterial("Elastic", 1, body.k_initial)
            else:
                f1 = body.k_unloading * FIRST
                f2 = f1 + body.k_initial * (body.knee - FIRST)
                f3 = f2 + body.k_hardening * 2.0
                points = (f1, FIRST, f2, body.knee, f3, body.knee + 2.0)
                negative = (-f1, -FIRST, -f2, -body.knee, -f3, -body.knee - 2.0)
                ops.uniaxialMaterial("Hysteretic", 1, *points, *negative, 1.0, 1.0, 0.0, 0.0, 0.0)
            for i in range(n):
                ops.element("zeroLength", i + 1, 1, 2, "-mat", 1, "-dir", 1)
            ops.setNodeVel(2, 1, case.speed, "-commit")
            ops.constraints("Plain")
            ops.numberer("Plain")
            ops.system("Diagonal")
            ops.algorithm("Linear")
            ops.integrator(*self.integrator)
            ops.analysis("Transient")

        def run(setting: float) -> Answer:
            # A run changes the model: built anew, which is not timed.
            build()
            crush = change = 0.0
            last, steps = case.speed, 0
            fastest = case.speed
            place = 0.0
            begin = time.perf_counter()
            while steps * setting < 1.0:
                ops.analyze(1, setting)
                steps += 1
                before, place = place, ops.nodeDisp(2, 1)
                now = (place - before) / setting  # at the middle of the step
                crush = max(crush, place)
                change = max(change, last - now)
                fastest = min(fastest, now)
                if now < 0.0 and now >= last:
                    break
                last = now
            taken = time.perf_counter() - begin
            return Answer(crush, change * body.mass / setting, -fastest, steps, taken)

        return run


# CentralDifference takes no initial velocity.
RIVALS = (ZeroLength("ExplicitDifference"),)
