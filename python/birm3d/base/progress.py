"""Bars for what takes long: on stderr of a terminal, and in the cell of a notebook."""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["in_notebook", "progress_bar", "run_bar"]

_FIRST = 1.0  # s, until a run shows its bar: most are over by then
_SELDOM = 10.0  # s, between the lines of a file


def in_notebook() -> bool:
    """Whether this is a kernel of Jupyter, which shows bars though its stderr is no terminal."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return shell is not None and "IPKernelApp" in shell.config


@contextmanager
def progress_bar(
    wanted: bool | None, title: str, total: int | None, done: int = 0
) -> Iterator[Callable[[int], None]]:
    """Show a bar on stderr or in the notebook and yield what moves it on.

    Parameters
    ----------
    wanted
        ``None``: if stderr is a terminal, and in notebooks.
    title, total, done
        What the bar says, how many there are (``None``: not known) and how many are done already.
    """
    if not _is_wanted(wanted):
        yield lambda _steps: None
        return
    with _bar_class()(total=total, initial=done, desc=title, file=sys.stderr, dynamic_ncols=True) as bar:

        def advance(steps: int) -> None:
            bar.update(steps)

        yield advance


@contextmanager
def run_bar(wanted: bool | None, duration: float | None) -> Iterator[Callable[[Any, Any], None] | None]:
    """Yield what one run calls with its time [s] and steps: a bar on stderr once it has taken a second.

    Parameters
    ----------
    wanted
        ``None``: if stderr is a terminal, and in notebooks.
    duration
        Of the run [s]; ``None``: not known.
    """
    if not _is_wanted(wanted):
        yield None
        return
    begin = time.monotonic()
    bar: Any = None

    def tick(now: Any, steps: Any) -> None:
        nonlocal bar
        first = bar is None
        if first:
            if time.monotonic() - begin < _FIRST:
                return
            bar = _bar_of_run(duration)
        bar.set_postfix_str(f"{steps:,} steps, Ctrl-C stops", refresh=False)
        bar.update(now - bar.n)
        if first:
            bar.refresh()

    try:
        yield tick
    finally:
        if bar is not None:
            bar.close()


def _is_wanted(wanted: bool | None) -> bool:
    return sys.stderr.isatty() or in_notebook() if wanted is None else wanted


def _bar_of_run(duration: float | None) -> Any:
    times = "[{elapsed}{postfix}]" if duration is None else "[{elapsed}<{remaining}{postfix}]"
    whole = "run: {n:.4g} s " if duration is None else "run: {percentage:.0f}%|{bar}| {n:.4g} of {total:g} s "
    shows = sys.stderr.isatty() or in_notebook()
    bar = _bar_class()(
        total=duration,
        file=sys.stderr,
        bar_format=whole + times,
        dynamic_ncols=True,
        leave=False,
        mininterval=0.2 if shows else _SELDOM,
        delay=_FIRST,  # nothing is written before the first update
    )
    bar.start_t -= _FIRST
    return bar


def _bar_class() -> Any:
    from tqdm import TqdmWarning

    with warnings.catch_warnings():
        # Without ipywidgets notebooks get a bar of text, which is as good.
        warnings.simplefilter("ignore", TqdmWarning)
        from tqdm.auto import tqdm

    class Bar(tqdm):  # type: ignore[misc]
        """A bar without a thread that watches it: a process pool may fork while that holds a lock."""

        monitor_interval = 0

    return Bar
