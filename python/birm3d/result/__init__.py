"""What comes out of a run: histories, scalars, loads, crush, balances and the files that hold them."""

from __future__ import annotations

from .result import Result

__all__ = ["Result"]
