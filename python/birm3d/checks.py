"""Numbers that callers give: refused by name where they are none, or more than can be held."""

from __future__ import annotations

from numbers import Real
from typing import Any

import numpy as np

__all__ = ["MOST_ELEMENTS", "MOST_RUNS", "check_runs", "number", "shown", "whole_number"]

MOST_ELEMENTS = 10_000
"""Of a barrier: a row of bollards 12 km long."""

MOST_RUNS = 5_000_000
"""Of one study: with all metrics they take some gigabytes of memory."""


def number(name: str, value: Any, kind: str = "a number") -> float:
    """Return a number as a float, also an infinite one or NaN.

    Raises
    ------
    ValueError
        If the value is none: a text, a list, ``None``, or too large for a float.
    """
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, Real):
        try:
            return float(value)
        except OverflowError:
            raise ValueError(f"{name} must be {kind} that a float can hold, got a larger one") from None
    raise ValueError(f"{name} must be {kind}, got {shown(value)}")


def whole_number(name: str, value: Any, least: int = 1, most: int | None = None) -> int:
    """Return a whole number, which a sweep may give as a float.

    Raises
    ------
    ValueError
        If the value is no whole number, or out of its limits.
    """
    found = value.item() if isinstance(value, np.ndarray) and value.ndim == 0 else value
    whole = isinstance(found, Real) and not isinstance(found, (bool, np.bool_))
    if not (whole and found >= least and found % 1 == 0):
        raise ValueError(f"{name} must be a whole number >= {least}, got {shown(value)}")
    if most is not None and found > most:
        raise ValueError(f"{name} must be at most {most:,}, got {shown(value)}")
    return int(found)


def check_runs(name: str, runs: int, how: str = "") -> None:
    """Refuse a study of more runs than can be held; `how` says what makes them so many."""
    if runs > MOST_RUNS:
        raise ValueError(f"{name} must make at most {MOST_RUNS:,} runs, got {runs:,}{how}")


def shown(value: Any) -> str:
    """Return a value as a message shows it, in one short line."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # more digits than Python prints
        return f"a {type(value).__name__} of more digits than Python prints"
    return text if len(text) <= 60 else text[:57] + "..."
