"""Names of numbers as texts have them."""

from __future__ import annotations

__all__ = ["plain_words"]


def plain_words(name: str) -> str:
    """Return a name in words: ``"wall_thickness"`` is ``"wall thickness"``.

    Tables of runs call metrics by the labels of their rows (:func:`birm3d.result.summary.shown_as`), and
    parameters of a scene as :func:`birm3d.study.shown_columns.parameter_words` says.
    """
    return name.replace("_", " ")
