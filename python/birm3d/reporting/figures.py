"""Figures of a page, as SVG inside it."""

from __future__ import annotations

import base64
import io
from typing import TYPE_CHECKING

from .blocks import Figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figure"]

_DPI = 170.0


def figure(drawing: Drawing, caption: str, *, raster: bool = False) -> Figure:
    """Return a figure of matplotlib as a picture that stays sharp in print; the same figure, the same bytes.

    raster: as PNG, for figures of so many parts that lines and areas would take megabytes.
    """
    import matplotlib as mpl

    stream = io.BytesIO()
    if raster:
        drawing.savefig(stream, format="png", dpi=_DPI, metadata={"Software": None})
        return Figure(caption, f"data:image/png;base64,{_text(stream)}", small=True)
    with mpl.rc_context({"svg.hashsalt": "birm3d", "svg.fonttype": "path", "path.simplify_threshold": 0.3}):
        drawing.savefig(stream, format="svg", metadata={"Date": None})
    return Figure(caption, f"data:image/svg+xml;base64,{_text(stream)}")


def _text(stream: io.BytesIO) -> str:
    return base64.b64encode(stream.getvalue()).decode("ascii")
