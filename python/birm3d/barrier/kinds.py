"""All kinds of barriers by the names that scene files and the command line have for them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .barrier import Barrier, Bollards, Jersey, MeshBarrier, Planter, Pole, RigidWall
from .jersey import PROFILES

__all__ = ["KINDS", "PROFILES", "Bollards", "Jersey", "MeshBarrier", "Planter", "Pole", "RigidWall"]

KINDS: Mapping[str, type[Barrier]] = MappingProxyType(
    {
        "rigid_wall": RigidWall,
        "pole": Pole,
        "bollards": Bollards,
        "jersey": Jersey,
        "planter": Planter,
    }
)
"""Kinds that sizes describe: ``Barrier.<name>()`` makes one."""
