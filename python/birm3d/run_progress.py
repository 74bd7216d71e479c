"""A line on stderr for a run that takes long."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["run_progress"]

_FIRST = 1.0  # s, until the first line: most runs are over by then
_OFTEN, _SELDOM = 0.2, 10.0  # s, between lines: of a terminal, which has one line, and of a file


@contextmanager
def run_progress(wanted: bool | None, duration: float | None) -> Iterator[Callable[[Any, Any], None] | None]:
    """Yield what a run calls with its time [s] and steps; after a second they are shown on stderr.

    Parameters
    ----------
    wanted
        ``None``: if stderr is a terminal.
    duration
        Of the run [s]; ``None``: not known.
    """
    terminal = sys.stderr.isatty()
    if not (terminal if wanted is None else wanted):
        yield None
        return
    begin = time.monotonic()
    due, shown = begin + _FIRST, False
    whole = "" if duration is None else f" of {duration:g} s"

    def tick(now: Any, steps: Any) -> None:
        nonlocal due, shown
        clock = time.monotonic()
        if clock < due:
            return
        due, shown = clock + (_OFTEN if terminal else _SELDOM), True
        line = f"{now:.4g} s{whole} computed in {clock - begin:.0f} s, {steps:,} steps; Ctrl-C stops"
        print(
            f"\r{line}\033[K" if terminal else line, end="" if terminal else "\n", file=sys.stderr, flush=True
        )

    try:
        yield tick
    finally:
        if terminal and shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)
