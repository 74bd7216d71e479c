"""Boxes of the rigid core that lie inside a skin."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..mesher import winding_number
from ..vehicle_file import VehicleFile

__all__ = ["core_inside"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def core_inside(file: VehicleFile, points: Floats, faces: Ints, told: list[str]) -> VehicleFile:
    """Return the file with core boxes narrow and low enough to lie inside the skin."""
    boxes = []
    for box in file.core:
        trial = box
        for step in range(13):
            (x0, x1), (z0, z1), y = trial.x_m, trial.z_m, trial.half_width_m
            corners = np.array([(a, b, c) for a in (x0, x1) for b in (-y, y) for c in (z0, z1)])
            if not (winding_number(corners, points, faces[:, [0, 1, 2, 2]]) < 0.5).any():
                break
            middle = 0.5 * (z0 + z1)
            low, high = (middle + 0.92 * (z - middle) for z in (z0, z1))
            ends = 0.5 * (x0 + x1)
            along = 1.0 if step < 6 else 0.95
            trial = trial.changed(
                {
                    "half_width_m": 0.92 * y,
                    "z_m": (low, high),
                    "x_m": tuple(ends + along * (x - ends) for x in (x0, x1)),
                }
            )
        else:
            raise ValueError(
                f"core must lie inside the skin, got box {box.name!r} of the class outside: give "
                "core={...}, or check forward, up and clearance"
            )
        if trial is not box:
            told.append(f"core box {box.name} made smaller, to lie inside the skin")
        boxes.append(trial)
    return file.changed({"core": tuple(boxes)})
