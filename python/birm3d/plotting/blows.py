"""Panels whose scale a blow of a few milliseconds would take from all the rest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

__all__ = ["name_cut_peaks", "readable_level"]

Floats = npt.NDArray[np.float64]

_BLOW = 0.02  # peaks that last for less in all are blows [s]
# A blow lasts for the first share of the loaded time at least, and for the second at most.
_LONG, _SHORT = 0.02, 0.25
_LOADED = 0.003  # a curve is loaded while it is above this share of its greatest value
_TIMES = 4.0  # a peak that is as many times the rest is cut off
_BEYOND = 1.2  # peaks that are as many times the edge of the panel are named
_ROOM = 1.6  # the panel's edge over the greatest value of the rest


def readable_level(values: Floats, interval: float) -> float:
    """Return the magnitude up to which a panel should show a curve, so that all but a blow can be read.

    It is the greatest one, but where the curve is above a quarter of it for less than 20 ms in all: then 1.6
    times what it exceeds for so long. Of long and short events the time is a share of that under load.

    Parameters
    ----------
    values
        Shape (n,), evenly spaced.
    interval
        Of the values [s].
    """
    sizes = np.abs(values)
    greatest = float(sizes.max(initial=0.0))
    loaded = interval * int(np.count_nonzero(sizes > _LOADED * greatest))
    lasts = min(max(_BLOW, _LONG * loaded), _SHORT * loaded)
    row = min(round(lasts / interval), len(sizes) - 1)
    rest = float(np.partition(sizes, len(sizes) - 1 - row)[len(sizes) - 1 - row])
    return greatest if rest <= 0.0 or greatest <= _TIMES * rest else _ROOM * rest


def name_cut_peaks(panel: Sequence[tuple[Axes, Sequence[tuple[Floats, Floats]], str]]) -> None:
    """Write the greatest peaks that a panel cuts off at its upper and at its lower edge.

    Parameters
    ----------
    panel
        Axes that share the panel, their limits final, with their curves (horizontal places and values) and
        the unit of these.
    """
    for sign in (1.0, -1.0):
        texts, places = [], []
        for axes, curves, unit in panel:
            edge = sign * axes.get_ylim()[sign > 0.0]
            found = [(float((sign * y).max(initial=0.0)), x, sign * y) for x, y in curves if len(y)]
            most, x, y = max(found, key=lambda one: one[0], default=(0.0, np.zeros(0), np.zeros(0)))
            if edge > 0.0 and most > _BEYOND * edge:
                texts.append(f"{sign * most:,.0f} {unit}")
                places.append(float(x[int(np.argmax(y))]))
        if texts:
            _write_peak(panel[-1][0], places[0], sign, " and ".join(texts))


def _write_peak(axes: Axes, place: float, sign: float, text: str) -> None:
    late = place > float(np.mean(axes.get_xlim()))
    axes.annotate(
        f"peak {text}",
        (place, 0.5 * (1.0 + sign)),
        (-7.0 if late else 7.0, -5.0 * sign),
        xycoords=("data", "axes fraction"),
        textcoords="offset points",
        ha="right" if late else "left",
        va="top" if sign > 0.0 else "bottom",
        fontsize="small",
        bbox={"fc": "w", "ec": "none", "pad": 1.0, "alpha": 0.85},
        zorder=7.0,
    )
