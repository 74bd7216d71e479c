"""A problem on its way to worker processes: packed once, unpacked once a process."""

from __future__ import annotations

import hashlib
import pickle
import threading
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .problem import Problem

__all__ = ["PackedProblem"]

# Problems that a process remembers; a calibration uses one.
_REMEMBERED = 4
_unpacked: dict[str, Problem] = {}
_lock = threading.Lock()


class PackedProblem:
    """Holds a problem; pickles as bytes that are made once.

    A mesh of 6,000 elements takes longer to pickle and to build again than to crash. Threads never pickle.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._packed: tuple[str, bytes] | None = None

    def __reduce__(self) -> tuple[object, ...]:
        with _lock:
            if self._packed is None:
                data = pickle.dumps(self.problem)
                self._packed = (hashlib.sha256(data).hexdigest(), data)
        return (_unpack, self._packed)


def _unpack(key: str, data: bytes) -> PackedProblem:
    with _lock:
        if key not in _unpacked:
            while len(_unpacked) >= _REMEMBERED:
                del _unpacked[next(iter(_unpacked))]
            _unpacked[key] = pickle.loads(data)
        problem = _unpacked[key]
    packed = PackedProblem(problem)
    packed._packed = (key, data)
    return packed
