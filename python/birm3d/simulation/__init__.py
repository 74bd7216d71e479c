"""Runs: the simulation of a scene, scenes by name and from files, and the names of their parameters."""

from __future__ import annotations

from .simulation import Scene, Simulation

__all__ = ["Scene", "Simulation"]
