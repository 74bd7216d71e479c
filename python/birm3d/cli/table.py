"""Command line: tables on stdout."""

from __future__ import annotations

import sys

__all__ = ["print_table"]


def print_table(table: object) -> None:
    """Print a table of rich, 132 columns wide where stdout is no terminal."""
    from rich.console import Console

    Console(width=None if sys.stdout.isatty() else 132).print(table)
