"""What :func:`birm3d.study.work_precision` returns."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from ... import pictures
from ...base.arguments import checked
from .precision_table import AS_GIVEN, PrecisionRow, PrecisionTable
from .recommendation import Recommendation, recommend, report

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["AS_GIVEN", "PrecisionRow", "WorkPrecision"]


@checked
class WorkPrecision(PrecisionTable):
    """Error of every metric against run time; see :func:`birm3d.study.work_precision`.

    Attributes
    ----------
    title : str
        The scene in a few words.
    rows : tuple of PrecisionRow
        Every setting of every variant, loosest first.
    converged : mapping of str to Limit
        Metric -> the scene's own converged value, with its uncertainty and observed order in the tolerance.
    of_variant : mapping of str to mapping
        Variant -> its own converged values; ``converged`` is that of ``"as given"``. Of ``"mesh"`` in the
        size of the elements.
    scales : mapping of str to float
        What the errors of each metric are relative to, in its unit.
    default : PrecisionRow
        That of the scene's own settings.
    """

    def plot(self, metrics: Collection[str] | None = None) -> Figure:
        """Return the work-precision figure: error against run time and against force evaluations, log-log."""
        return pictures.plot_work_precision(self, metrics)

    def requested_vs_achieved(self, metrics: Collection[str] | None = None) -> Figure:
        """Return a figure of the achieved error of each metric against the tolerance asked for, log-log."""
        return pictures.plot_requested_vs_achieved(self, metrics)

    def recommend(self, error: float = 0.01, metrics: Collection[str] | None = None) -> Recommendation:
        """Return the cheapest setting with a wanted error.

        A setting counts if it and all stricter ones of its kind have the error in every metric. The
        uncertainty of the converged value is added. A small error between larger ones does not count.

        Parameters
        ----------
        error
            Relative, > 0.
        metrics
            Those that matter; ``None``: all.

        Raises
        ------
        ValueError
            If no setting has this error, or the converged value is not known so well; the message names the
            least that can be had. If a metric is unknown.
        """
        return recommend(self, error, metrics)

    def report(self, error: float = 0.01) -> str:
        """Return in words what errors cost, and the cheapest setting for a wanted one."""
        return report(self, error)

    def __repr__(self) -> str:
        return f"WorkPrecision({self.title}, {len(self.rows)} rows, {len(self.scales)} metrics)"
