"""Histories in which runs are compared: name, unit and how they follow from a result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .. import units
from ..base.frozen_mapping import FrozenMapping
from ..signals.filters import cfc
from .record import RunRecord

__all__ = ["HISTORY_CHANNELS", "HistoryChannel", "checked_channels"]

Floats = npt.NDArray[np.float64]

_STRUCTURE = 60.0  # SAE J211-1, vehicle structure and barrier forces


class HistoryChannel(NamedTuple):
    """A history that figures show.

    Attributes
    ----------
    label : str
    unit : str
        In which pictures show it.
    size : float
        SI per that unit.
    values : callable
        Result -> array of shape (n,), SI, angles in degrees.
    """

    label: str
    unit: str
    size: float
    values: Callable[[RunRecord], Floats]


def _filtered(signal: Floats, interval: float) -> Floats:
    """Return a signal after CFC 60; as it is where the rows are too far apart for that."""
    return signal if interval * _STRUCTURE > 0.1 else cfc(signal, _STRUCTURE, interval)


def _deceleration(result: RunRecord) -> Floats:
    return _filtered(-result.acceleration[:, 0], result.scene.settings.output_interval)


def _barrier_force(result: RunRecord) -> Floats:
    return _filtered(result.barrier_normal_force, result.scene.settings.output_interval)


def _heading(result: RunRecord) -> Floats:
    start = result.velocity[0]
    speed = float(np.linalg.norm(start))
    return np.asarray(start / speed if speed > 0.0 else np.array([1.0, 0.0, 0.0]))


def _velocity(result: RunRecord) -> Floats:
    return np.asarray(result.velocity @ _heading(result))


def _travel(result: RunRecord) -> Floats:
    return np.asarray((result.position - result.position[0]) @ _heading(result))


HISTORY_CHANNELS = FrozenMapping(
    {
        "deceleration": HistoryChannel("deceleration along the vehicle, CFC 60", "g", units.g, _deceleration),
        "barrier_force": HistoryChannel("barrier force, normal, CFC 60", "kN", units.kN, _barrier_force),
        "velocity": HistoryChannel("velocity along the path", "m/s", 1.0, _velocity),
        "travel": HistoryChannel("travel along the path", "m", 1.0, _travel),
        "roll": HistoryChannel("roll", "deg", 1.0, lambda result: result.roll),
        "pitch": HistoryChannel("pitch", "deg", 1.0, lambda result: result.pitch),
        "yaw": HistoryChannel("yaw", "deg", 1.0, lambda result: result.yaw),
    }
)
"""Name -> channel; of the mass centre of the leading unit.

Where rows are too far apart for a class (SAE J211-1), the history is not filtered.
"""


def checked_channels(names: Sequence[str]) -> tuple[str, ...]:
    """Return names of channels, each once.

    Raises
    ------
    ValueError
        If there is none, or one is unknown.
    """
    if isinstance(names, str):
        names = (names,)
    found = tuple(dict.fromkeys(names))
    if not found:
        raise ValueError(f"channels must be at least one of {', '.join(HISTORY_CHANNELS)}, got none")
    for name in found:
        if name not in HISTORY_CHANNELS:
            raise ValueError(f"channels must be among {', '.join(HISTORY_CHANNELS)}; got {name!r}")
    return found
