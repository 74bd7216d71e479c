"""Measured curves to hold a result against."""

from __future__ import annotations

import csv
from importlib import resources

import numpy as np
import numpy.typing as npt

__all__ = ["nhtsa_10146"]

Floats = npt.NDArray[np.float64]


def nhtsa_10146() -> dict[str, Floats]:
    """Return the curves of NHTSA test 10146, one row a millisecond.

    A 2018 Toyota Camry of 1,719 kg at 57.09 km/h into a rigid load-cell wall (NHTSA vehicle crash test
    database; a work of the United States government). The scene is :func:`birm3d.scenes.nhtsa_10146`.

    The motion is that of the momentum centre: the wall force, integrated over the mass. This is the signal
    that a vehicle of one rigid body owns. The accelerometers in the compartment show another one, as engine
    and cabin do not move as one body: the engine stops after 38 ms and 0.46 m while the cabin goes on to
    0.74 m, and wall force against that way makes 15 % more work than there was energy.

    Returns
    -------
    dict of ndarray, shape (n,), read-only
        ``time`` since the first touch [s]; ``wall_force``, sum of 176 load cells, SAE J211 CFC 60 [N];
        ``velocity`` [m/s] and ``displacement`` [m] of the momentum centre towards the wall.
    """
    file = resources.files("birm3d") / "data" / "nhtsa_10146.csv"
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    rows = list(csv.reader(lines))
    names = {
        "time_s": "time",
        "wall_force_N": "wall_force",
        "velocity_m_s": "velocity",
        "displacement_m": "displacement",
    }
    table = np.array(rows[1:], float)
    table.setflags(write=False)
    return {names[head]: table[:, i] for i, head in enumerate(rows[0])}
