"""One measured or computed history: numbers with their time, unit, filter class and origin."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..base.arguments import checked
from .channel_checks import Findings, check_channel
from .samples import Samples

__all__ = ["Channel", "total"]


@checked
@dataclass(frozen=True, eq=False, repr=False)
class Channel(Samples):
    """A history; immutable, arrays are read-only copies.

    Parameters
    ----------
    name
        What a plot calls it.
    time
        Shape (n,), n > 1, strictly increasing [s].
    values
        Shape (n,), finite, in `unit`.
    unit
        One that :func:`birm3d.units.measure` knows, such as ``"kN"`` or ``"g"``.
    cfc
        Channel frequency class (SAE J211-1) that the values have been filtered to; None: no such filter.
    source
        Where it is from: file and line, or test number.
    info
        Anything else that is known of it: sensor, location, comments.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value.
    """

    def check(self, **expected: Any) -> Findings:
        """Return what its sign, unit, time zero, bias and sampling look like against what is expected.

        Parameters as in :func:`birm3d.check_channel`.
        """
        return check_channel(self, **expected)


def total(channels: Iterable[Channel], name: str) -> Channel:
    """Return the sum of channels, such as the cells of a load-cell wall, in the unit used here.

    Raises
    ------
    ValueError
        If there is none, or they differ in quantity, filter class or instants.
    """
    parts = [channel.to_si() for channel in channels]
    if not parts:
        raise ValueError("channels must be at least one, got none")
    first = parts[0]
    for part in parts[1:]:
        for what in ("quantity", "cfc"):
            if getattr(part, what) != getattr(first, what):
                raise ValueError(
                    f"channels must have one {what}, got {getattr(first, what)} of {first.name!r} and "
                    f"{getattr(part, what)} of {part.name!r}"
                )
        if len(part) != len(first) or np.abs(part.time - first.time).max() > 1e-9:
            raise ValueError(f"channels must have the same instants, got others in {part.name!r}")
    values = np.sum([part.values for part in parts], axis=0)
    source = first.source if len(parts) == 1 else f"{len(parts)} channels, the first from {first.source}"
    return Channel(name, first.time, values, first.unit, first.cfc, source)
