"""A result as one HTML page that opens without a network. plotly is imported here only.

It comes with ``pip install 'birm3d[html]'``. Of plotly only its script is used. The page contains it, at the
cost of about 5 MB. It provides zooming, reading of values and hiding of curves.
"""

from __future__ import annotations

from .page import write_html

__all__ = ["write_html"]
