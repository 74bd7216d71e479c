"""Runs: the simulation of a scene, scenes by name and from files, and the names of their parameters."""

from __future__ import annotations

from ..scene.scene import Scene
from .simulation import Simulation

__all__ = ["Scene", "Simulation"]
