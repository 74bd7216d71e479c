"""A result as one HTML page that opens without a network. plotly is imported here only.

It comes with ``pip install 'birm3d[html]'``. Of plotly only its script is used. It goes into the page, which
has about 5 MB for that, and gives zooming, reading of values and hiding of curves, which a page of our own
would have to be taught.
"""

from __future__ import annotations

from .page import write_html

__all__ = ["write_html"]
