"""Command line: results on stdout, everything else on stderr."""

from __future__ import annotations

from .commands import main

__all__ = ["main"]
