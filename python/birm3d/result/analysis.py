"""What follows from the record of a run: loads of elements, scalars and what became of the vehicle."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from .element_loads import ElementLoad, element_loads
from .event import Metrics, metrics_of, outcome_detail
from .record import RunRecord
from .segment_motion import overturning_ratio
from .unit_result import read_only

__all__ = ["RunAnalysis"]

Floats = npt.NDArray[np.float64]


@checked
class RunAnalysis(RunRecord):
    """A record with all that is computed of it; texts, tables and pictures are made of an analysis."""

    @property
    def outcome_detail(self) -> str:
        """How the outcome came about: one sentence."""
        return outcome_detail(self)

    @cached_property
    def element_loads(self) -> tuple[ElementLoad, ...]:
        """Force, moment and resultant height of every element of the barrier; () without a barrier.

        See :class:`birm3d.result.element_loads.ElementLoad` for frames and signs.
        """
        return element_loads(self)

    @cached_property
    def overturning_ratio(self) -> Floats:
        """Overturning over restoring moment of each free-standing segment, 50-ms means, shape (n, k).

        Above 1 it would begin to tip, which the model leaves out; see
        :func:`birm3d.result.segment_motion.overturning_ratio`.
        """
        if self._segments == 0:
            return read_only(np.zeros((len(self.time), 0)))
        return read_only(overturning_ratio(self, self.element_loads))

    @cached_property
    def metrics(self) -> Metrics:
        """Scalars in SI, angles in degrees; see :mod:`birm3d.metrics`. Only those that the run has.

        A name that is absent raises a KeyError that says why.
        """
        return metrics_of(self)
