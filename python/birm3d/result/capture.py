"""Frames of a finished run.

The core is deterministic, so frames are taken by running the scene once more; that both end in the same bits
is checked.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..io.made_with import code_text
from ..vehicle.unit_shapes import unit_shapes
from .frames import Frames, frame_times
from .record import RunRecord

__all__ = ["capture"]


def capture(result: RunRecord, frames: int | Sequence[float] | npt.NDArray[np.float64]) -> Frames:
    """Run the scene of a result once more and return its frames, linear between the ends of steps.

    Raises
    ------
    ValueError
        If the frames are outside the run. If the scene does not end in the same bits as the result, because
        another version of the package made it.
    """
    times = frame_times(result.time, frames)
    core = result.scene.start()
    rest = [shape.nodes for shape in unit_shapes(result.scene.vehicle)]
    taken = [np.empty((len(times), len(nodes), 3), np.float32) for nodes in rest]
    before = [core.nodes(unit) for unit in range(len(rest))]
    began, k = core.time, 0
    for _ in range(result.statistics.steps):
        core.step()
        now = [core.nodes(unit) for unit in range(len(rest))]
        while k < len(times) and times[k] <= core.time:
            share = (times[k] - began) / (core.time - began)
            for unit, nodes in enumerate(rest):
                taken[unit][k] = before[unit] + share * (now[unit] - before[unit]) - nodes
            k += 1
        before, began = now, core.time
    if core.state_hash != result.state_hash:
        raise ValueError(
            f"frames need a scene that runs the same way again: the result ended in state "
            f"{result.state_hash:016x}, its scene now in {core.state_hash:016x} "
            f"(result of {code_text(result.made_with)})"
        )
    for unit, nodes in enumerate(rest):  # rows that the clock's rounding puts after the last step
        taken[unit][k:] = before[unit] - nodes
    return Frames(times, tuple(taken))
