"""Pictures and movies in three dimensions, off-screen or in a window. pyvista is imported here only.

It comes with ``pip install 'birm3d[render]'``.
"""

from __future__ import annotations

from .camera import VIEWS, View
from .movie import animate
from .stage import Color, Stage
from .stills import render, show

__all__ = ["VIEWS", "Color", "Stage", "View", "animate", "render", "show"]
