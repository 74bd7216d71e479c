"""MuJoCo with our law in a compiled callback: the honest closest rival.

The callback (crush_callback.c) and the loop over mj_step are compiled by the benchmark, for this machine,
with value-changing optimisations allowed; nothing of a run is Python. Constraints are switched off: no
collision search, no solver. Semi-implicit Euler is leapfrog here, as nothing pushes at t = 0; Runge-Kutta
of fourth order is the other row.
"""

from __future__ import annotations

import ctypes
import functools
import math
import shutil
import subprocess
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .definition import STEPS, AbsentError, Answer, Case, Run, block, heading

COLUMNS = ("x", "y", "z", "ax", "ay", "az", "length", "residual", "force", "deflection")
FLAGS = ("-O3", "-march=native", "-ffast-math", "-fopenmp-simd", "-shared", "-fPIC")


class Crush(ctypes.Structure):
    """The C struct of the same name."""

    _fields_ = (
        *((name, ctypes.c_int) for name in ("n", "first", "left")),
        *((name, ctypes.POINTER(ctypes.c_double)) for name in COLUMNS),
        *((name, ctypes.c_double) for name in ("k_initial", "knee", "k_hardening", "k_unloading", "mu")),
        *((name, ctypes.c_double) for name in ("peak", "peak_force")),
    )


def engine() -> Any:
    try:
        import mujoco
    except ImportError as error:
        raise AbsentError(f"mujoco is not installed ({error})") from None
    return mujoco


@functools.cache
def compiled() -> tuple[Any, Any, Any]:
    """The compiled callback's driver, mj_step, and the place of MuJoCo's hook."""
    mujoco = engine()
    compiler = shutil.which("gcc") or shutil.which("clang") or shutil.which("cc")
    if compiler is None:
        raise AbsentError("no C compiler (gcc, clang) for the callback")
    home = Path(mujoco.__file__).parent
    source = Path(__file__).with_name("crush_callback.c")
    folder = tempfile.mkdtemp(prefix="birm3d_rivals_")
    target = Path(folder) / "crush_callback.so"
    done = subprocess.run(
        [compiler, *FLAGS, f"-I{home / 'include'}", str(source), "-o", str(target), "-lm"],
        capture_output=True,
        text=True,
    )
    if done.returncode != 0:
        raise AbsentError(f"the callback does not compile: {done.stderr[:300]}")
    own = ctypes.CDLL(str(target))
    shutil.rmtree(folder)
    library = ctypes.CDLL(str(next(home.glob("libmujoco.*"))))
    own.drive.restype = ctypes.c_int
    own.drive.argtypes = [ctypes.c_void_p] * 5 + [ctypes.c_int] * 2
    step = ctypes.cast(library.mj_step, ctypes.c_void_p)
    hook = ctypes.addressof(ctypes.c_void_p.in_dll(library, "mjcb_passive"))
    return own.drive, step, hook


def body_xml(mass: float, inertia: Sequence[float], integrator: str, more: str = "", flags: str = "") -> str:
    diagonal = " ".join(map(str, inertia))
    return f"""<mujoco><option gravity="0 0 0" integrator="{integrator}" {more}><flag {flags}/></option>
    <worldbody>%s<body name="vehicle"><freejoint/>
    <inertial pos="0 0 0" mass="{mass}" diaginertia="{diagonal}"/>%s</body></worldbody></mujoco>"""


@functools.cache
def free_body(integrator: str) -> tuple[Any, Any]:
    """Model and data of a free body; its mass is set anew for each run, which spares a batch the compiler."""
    mujoco = engine()
    off = 'constraint="disable" contact="disable"'
    model = mujoco.MjModel.from_xml_string(body_xml(1.0, (1.0, 1.0, 1.0), integrator, flags=off) % ("", ""))
    return model, mujoco.MjData(model)


class Callback:
    does_more = "joints, actuators, general collision and convex friction, all switched off here"
    settings = STEPS
    wrong: Mapping[str, str] = {}

    def __init__(self, integrator: str) -> None:
        self.integrator = integrator
        self.name = f"MuJoCo, our law in a callback, {integrator}"
        self.setup = (
            f"mjcb_passive and the loop compiled ({' '.join(FLAGS[:3])}), constraints off, {integrator}"
        )

    def build(self, case: Case, n: int) -> Run:
        drive, step, hook = compiled()
        mujoco = engine()
        body = block(case, n)
        model, data = free_body(self.integrator)
        columns = {name: np.zeros(n) for name in COLUMNS}
        crush = Crush(n=n, mu=case.friction)
        for name in ("k_initial", "knee", "k_hardening", "k_unloading"):
            setattr(crush, name, getattr(body, name))
        for name, column in columns.items():
            setattr(crush, name, column.ctypes.data_as(ctypes.POINTER(ctypes.c_double)))
        columns["length"][:] = np.linalg.norm(body.nodes - body.anchors, axis=1)
        for name, values in zip(("ax", "ay", "az"), body.anchors.T, strict=True):
            columns[name][:] = values
        yaw = 0.5 * math.radians(90.0 - case.angle)
        start = float((body.nodes @ heading(case)).min())

        def run(setting: float) -> Answer:
            mujoco.mj_resetData(model, data)
            model.opt.timestep = setting
            model.body_mass[1] = body.mass
            model.body_inertia[1] = body.inertia
            mujoco.mj_setConst(model, data)
            for name, values in zip(("x", "y", "z"), body.nodes.T, strict=True):
                columns[name][:] = values
            for name in ("residual", "force", "deflection"):
                columns[name].fill(0.0)
            crush.peak = crush.peak_force = 0.0
            data.qpos[:] = (start, 0.0, 0.0, math.cos(yaw), 0.0, 0.0, math.sin(yaw))
            angle = math.radians(case.angle)
            data.qvel[:] = (case.speed * math.sin(angle), case.speed * math.cos(angle), 0.0, 0.0, 0.0, 0.0)
            most = math.ceil((case.duration or 1.0) / setting - 1e-9)
            begin = time.perf_counter()
            steps = drive(
                ctypes.addressof(crush), model._address, data._address, step, hook, most,
                int(case.duration is not None),
            )  # fmt: skip
            taken = time.perf_counter() - begin
            speed = float(np.hypot(*data.qvel[:2]))
            return Answer(crush.peak, crush.peak_force, speed, steps, taken)

        return run


RIVALS = (Callback("Euler"), Callback("RK4"))
