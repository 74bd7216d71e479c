"""Energies against time: each term has a colour and a style of its own, the same in every figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from ..base.plain_words import plain_words
from .style import BLUE, DASH_DOT, DASHED, DOTTED, GREEN, ORANGE, RED, SOLID, Style, legend

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["energy_look", "plot_energies", "shown_energies"]

_LEAST_SHARE = 1e-3  # of the total: terms below are not drawn


class _Look(NamedTuple):
    color: str
    style: Style
    width: float


_LOOKS = {
    "total": _Look("#000000", SOLID, 2.6),
    "kinetic": _Look(BLUE, SOLID, 1.8),
    "crushed": _Look(RED, SOLID, 1.8),
    "stored": _Look(GREEN, DASHED, 1.6),
    "potential": _Look("#56B4E9", DASH_DOT, 1.6),
    "barrier_friction": _Look(ORANGE, DASHED, 1.6),
    "tire_friction": _Look("#CC79A7", DASH_DOT, 1.6),
    "ground_friction": _Look("#8C564B", DOTTED, 1.8),
    "impacts": _Look("#7F7F7F", DASHED, 1.6),
    "barrier_ground_friction": _Look("#A39A00", DASH_DOT, 1.6),
    "joints": _Look("#5D3A9B", DOTTED, 1.8),
    "yielding": _Look("#393B79", DASH_DOT, 1.8),
}
# For terms that have no look above, in their order.
_OTHERS = ("#17BECF", "#9EDAE5", "#C49C94", "#98DF8A", "#F7B6D2", "#637939")


def energy_look(names: list[str]) -> dict[str, tuple[str, Style, float]]:
    """Return colour, line style and width of each term; no two terms share a colour."""
    unknown = [name for name in names if name not in _LOOKS]
    others = {name: _Look(_OTHERS[i % len(_OTHERS)], DASHED, 1.4) for i, name in enumerate(unknown)}
    return {name: _LOOKS.get(name) or others[name] for name in names}


def shown_energies(result: Result) -> dict[str, npt.NDArray[np.float64]]:
    """Return the terms that are worth drawing, name -> shape (n,) [J]: at least 0.1 % of the total."""
    least = _LEAST_SHARE * float(np.abs(result.energy["total"]).max())
    return {
        name: values
        for name, values in result.energy.items()
        if name != "residual" and float(np.abs(values).max()) > least
    }


def plot_energies(axes: Axes, result: Result) -> None:
    """Draw the energy balance into a panel."""
    shown = shown_energies(result)
    looks = energy_look(list(result.energy))
    for name, values in shown.items():
        color, style, width = looks[name]
        label = plain_words(name)
        axes.plot(result.time * 1e3, values / 1e3, color=color, ls=style, lw=width, label=label)
    axes.set_ylabel("energy [kJ]")
    axes.set_title("Energy balance")
    legend([axes])
