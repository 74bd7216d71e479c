"""Bars on stderr for what takes long."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

__all__ = ["progress_bar"]


@contextmanager
def progress_bar(
    wanted: bool | None, title: str, total: int | None, done: int = 0
) -> Iterator[Callable[[int], None]]:
    """Show a bar on stderr and yield what moves it on.

    Parameters
    ----------
    wanted
        ``None``: if stderr is a terminal.
    title, total, done
        What the bar says, how many there are (``None``: not known) and how many are done already.
    """
    if wanted is None:
        wanted = sys.stderr.isatty()
    if not wanted:
        yield lambda steps: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    # No refreshing thread: a process pool may fork while it holds a lock.
    with Progress(*columns, console=Console(stderr=True), auto_refresh=False) as bar:
        task = bar.add_task(title, total=total, completed=done)

        def advance(steps: int) -> None:
            bar.update(task, advance=steps, refresh=True)

        yield advance
