"""What titles call a vehicle: the words of its file, and the mass that it has."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Protocol

__all__ = ["kind_words", "title_of_name", "vehicle_text", "without_mass"]

_MASS = re.compile(r"(,| of) \d[\d.,]* (kg|lb|t)( loaded)?$")


class _Titled(Protocol):
    """A vehicle, of which only these are asked."""

    @property
    def title(self) -> str: ...

    @property
    def mass(self) -> float: ...


def without_mass(title: str) -> str:
    """Return the title of a file without its mass at the end: the vehicle may have another one."""
    return _MASS.sub("", title)


def kind_words(text: str) -> str:
    """Return a kind of vehicle, or a text with such kinds, in words: ``"cab-over truck"``."""
    return text.replace("cab_over", "cab-over").replace("_", " ")


def vehicle_text(vehicle: _Titled, decimals: int = 0) -> str:
    """Return title and mass of a vehicle, as ``"Cargo truck, 6,804 kg"``."""
    return f"{vehicle.title}, {vehicle.mass:,.{decimals}f} kg"


@lru_cache(maxsize=256)
def title_of_name(name: str) -> str:
    """Return the title of the preset of this name; of another name its words."""
    from ..io.toml import Document
    from .vehicle_file import preset_names, preset_path

    if name in preset_names():
        return without_mass(str(Document(preset_path(name)).data["title"]))
    words = name.replace("_", " ")
    return words[:1].upper() + words[1:]
