"""Warnings of names of earlier versions, which go on working."""

from __future__ import annotations

import warnings

from .arguments import caller_level

__all__ = ["warn_deprecated", "warn_renamed"]


def warn_deprecated(text: str) -> None:
    """Warn the line that called this package with a :class:`DeprecationWarning`."""
    warnings.warn(text, DeprecationWarning, stacklevel=caller_level())


def warn_renamed(old: str, new: str) -> None:
    """Warn that something has a new name, and say which."""
    warn_deprecated(f"{old} has a new name: write {new}")
