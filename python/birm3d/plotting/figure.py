"""Figures that notebooks show by themselves."""

from __future__ import annotations

import io
from typing import Any

from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

__all__ = ["ShownFigure", "new_figure"]


class ShownFigure(Figure):
    """A :class:`matplotlib.figure.Figure` that a notebook shows where it is the last value of a cell.

    matplotlib's own figures need ``%matplotlib inline`` for that. Where this is set, its settings hold.
    """

    def _repr_png_(self) -> bytes:
        stream = io.BytesIO()
        self.savefig(stream, format="png")
        return stream.getvalue()


def new_figure(width: float, height: float, **options: Any) -> ShownFigure:
    """Return an empty figure of so many inches whose parts make room for each other."""
    layout = ConstrainedLayoutEngine(h_pad=0.07)  # inches; less lets a legend below touch the axes' label
    return ShownFigure(figsize=(width, height), layout=layout, **options)
