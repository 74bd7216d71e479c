"""The dossier of a run: one page for the file of a project, with what a reviewer asks for.

It has verdict, scene, vehicle and its sources, loads, occupant risk, uncertainty and published tests nearby.
Energy and momentum balance follow, what was left out, and a capsule that runs again to the same bits.
"""

from __future__ import annotations

from .build import dossier

__all__ = ["dossier"]
