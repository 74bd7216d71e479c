"""Bars for what takes long: on stderr of a terminal, and in the cell of a notebook."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["in_notebook", "progress_bar"]


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
    if wanted is None:
        wanted = sys.stderr.isatty() or in_notebook()
    if not wanted:
        yield lambda steps: None
        return
    with _bar_class()(total=total, initial=done, desc=title, file=sys.stderr, dynamic_ncols=True) as bar:

        def advance(steps: int) -> None:
            bar.update(steps)

        yield advance


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
