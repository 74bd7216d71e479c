"""What comes out of a run: histories, scalars, loads, crush, accounts and the file that keeps them."""

from __future__ import annotations

from .result import Result

__all__ = ["Result"]
