"""Numbers that callers give: refused by name where they are none, or more than can be held."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = [
    "MOST_ELEMENTS",
    "MOST_NODES",
    "MOST_RUNS",
    "array",
    "check_runs",
    "index",
    "is_number",
    "is_whole",
    "number",
    "pair",
    "positive_and_finite",
    "shown",
    "whole_number",
]

MOST_ELEMENTS = 10_000
"""Of a barrier: a row of bollards 12 km long."""

MOST_NODES = 1_000_000
"""Of a laboratory body."""

MOST_RUNS = 5_000_000
"""Of one study: with all metrics they take some gigabytes of memory."""


def is_number(value: Any) -> bool:
    """Whether a value is a number that a float can hold, also an infinite one or NaN; a bool is none."""
    if isinstance(value, float):
        return True
    value = _of_no_shape(value)
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, Real):
        return False
    try:
        float(value)
    except OverflowError:
        return False
    return True


def is_whole(value: Any) -> bool:
    """Whether a value is a whole number, which a sweep may give as a float."""
    value = _of_no_shape(value)
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, Real):
        return False
    return bool(value % 1 == 0)


def number(name: str, value: Any, kind: str = "a number") -> float:
    """Return a number as a float, also an infinite one or NaN.

    Raises
    ------
    ValueError
        If the value is none: a text, a list, a bool, ``None``, or too large for a float.
    """
    if is_number(value):
        return float(value)
    if is_whole(value):
        raise ValueError(f"{name} must be {kind} that a float can hold, got a larger one")
    raise ValueError(f"{name} must be {kind}, got {shown(value)}")


def pair(name: str, value: Sequence[float]) -> tuple[float, float]:
    """Return two numbers; a ValueError says where there are not two."""
    if len(value) != 2:
        raise ValueError(f"{name} must be two numbers, got {shown(value)}")
    return number(name, value[0]), number(name, value[1])


def positive_and_finite(name: str, value: float, unit: str = "m") -> None:
    """Refuse what is not finite and > 0, a length where no other unit is named."""
    if not 0.0 < value < math.inf:
        raise ValueError(f"{name} must be finite and > 0 {unit}, got {value}")


def index(name: str, value: Any, count: int, things: str) -> int:
    """Return the place of one of so many things, from 0.

    Raises
    ------
    ValueError
        If the value is no whole number, or there is no such thing.
    """
    if not (is_whole(value) and 0 <= value < count):
        raise ValueError(f"{name} must be >= 0 and < {count}, the number of {things}, got {shown(value)}")
    return int(value)


def array(name: str, value: Any, *shape: int | str) -> npt.NDArray[np.float64]:
    """Return an array of numbers of a shape as ("n", 3), where a letter stands for any length.

    Raises
    ------
    ValueError
        If the value is no array of numbers, or of another shape.
    """
    try:
        found = np.asarray(value, float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be an array of numbers, got {shown(value)}") from None
    fits = len(shape) == found.ndim
    if not fits or any(isinstance(n, int) and n != m for n, m in zip(shape, found.shape, strict=True)):
        wanted, given = (", ".join(map(str, sizes)) for sizes in (shape, found.shape))
        raise ValueError(f"{name} shape must be ({wanted}), got ({given})")
    return found


def whole_number(name: str, value: Any, least: int = 1, most: int | None = None) -> int:
    """Return a whole number, which a sweep may give as a float.

    Raises
    ------
    ValueError
        If the value is no whole number, or out of its limits.
    """
    if not (is_whole(value) and value >= least):
        raise ValueError(f"{name} must be a whole number >= {least}, got {shown(value)}")
    if most is not None and value > most:
        raise ValueError(f"{name} must be at most {most:,}, got {shown(value)}")
    return int(value)


def _of_no_shape(value: Any) -> Any:
    return value.item() if isinstance(value, np.ndarray) and value.ndim == 0 else value


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
