"""How a kind of barrier describes itself: its sizes by name, its words, and how wide it is for a vehicle."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

__all__ = ["SeenPart", "Size", "height_text", "length_text", "segments_text"]

_KEY_ENDINGS: Mapping[str, str] = MappingProxyType({"length": "_m", "density": "_kg_m3", "pressure": "_Pa"})


@dataclass(frozen=True)
class Size:
    """One size of a kind of barrier: from it follow the key in scene files and the command-line option.

    Attributes
    ----------
    name
        Argument of ``Barrier.<kind>()``.
    quantity
        ``"length"``, ``"density"``, ``"pressure"``, ``"count"``, ``"flag"`` (the option says yes),
        ``"choice"``, or ``"foundation"`` (a table of scene files, an option for each number).
    hint
        What ``--help`` says beside the kinds that have it.
    choices
        Words that a choice has.
    """

    name: str
    quantity: str = "length"
    hint: str = ""
    choices: tuple[str, ...] = ()

    @property
    def key(self) -> str:
        """Its key in scene files: the name with the unit."""
        return self.name + _KEY_ENDINGS.get(self.quantity, "")

    @property
    def unit(self) -> str:
        """In SI; "" for what is no quantity."""
        return {"length": "m", "density": "kg/m^3", "pressure": "Pa"}.get(self.quantity, "")


@dataclass(frozen=True)
class SeenPart:
    """A part of a barrier: its width seen along the path, and between which heights it is [m]."""

    name: str
    width: float
    low: float
    high: float


def length_text(length: float) -> str:
    """Return a length in words."""
    return "without end" if math.isinf(length) else f"{length:g} m long"


def height_text(height: float) -> str:
    """Return a height in words."""
    return "without a top" if math.isinf(height) else f"{height:.3g} m high"


def segments_text(count: int) -> str:
    """Return a number of segments in words; one needs none."""
    return f" in {count} segments" if count > 1 else ""
