"""Parameters of many runs, where all are numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

__all__ = ["FloatRows"]


class FloatRows(Sequence[tuple[float, ...]]):
    """Rows of numbers, held in an array (n, k) and handed out as tuples."""

    def __init__(self, array: npt.NDArray[np.float64]) -> None:
        self.array = array

    def __len__(self) -> int:
        return len(self.array)

    def __getitem__(self, row: int) -> tuple[float, ...]:  # type: ignore[override]  # of one row, no slices
        return tuple(self.array[row].tolist())
