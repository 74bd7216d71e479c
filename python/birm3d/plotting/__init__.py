"""Figures of runs and of comparisons with measurements. matplotlib is imported here only.

Every function returns a :class:`matplotlib.figure.Figure` and shows nothing. Lengths are in m, forces in kN,
angles in degrees, times in ms; filtered channels say their channel frequency class (SAE J211-1).
"""

from __future__ import annotations

from .comparisons import plot_comparison, plot_comparisons
from .crush import plot_crush
from .elements import plot_elements
from .histories import plot_histories
from .overview import plot_result
from .plan import plot_plan
from .thumbnail import plot_thumbnail

__all__ = [
    "plot_comparison",
    "plot_comparisons",
    "plot_crush",
    "plot_elements",
    "plot_histories",
    "plot_plan",
    "plot_result",
    "plot_thumbnail",
]
