"""Threads where the user gives no executor."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager

__all__ = ["threads_unless"]


@contextmanager
def threads_unless(executor: Executor | None, jobs: int | None = None) -> Iterator[Executor]:
    """Give the executor, or one of `jobs` threads (``None``: one a processor) that ends with the block."""
    if executor is not None:
        yield executor
        return
    if jobs is not None and jobs < 1:
        raise ValueError(f"jobs must be >= 1, got {jobs}")
    with ThreadPoolExecutor(max_workers=jobs or os.cpu_count() or 1) as threads:
        yield threads
