"""The runs of a study of errors: carried out in turn, as far as one lets them, and judged together."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from ...barrier.text import barrier_text
from ...base.progress import progress_bar
from ...scene.text import pose_text
from ...simulation.simulation import Simulation
from .convergence import Limit
from .precision_result import AS_GIVEN, WorkPrecision
from .precision_runs import PrecisionRun, limits_of, refuse_stricter, row_of
from .precision_table import PrecisionRow

__all__ = ["PrecisionPlan"]


@dataclass
class PrecisionPlan:
    """The runs of a study of errors, each an entry of one of four lists.

    Attributes
    ----------
    simulation
        The scene as given.
    runs
        Of the scene and its other models, at tolerances and fixed steps.
    sharp
        The same at the tolerances of the converged answers.
    coarse, meshed
        With other meshes, at the scene's own settings and at the strictest tolerance of ``runs``.
    variants
        ``"as given"``, then the names of the other models.
    wanted, least
        Metrics, and the least scale of each.
    """

    simulation: Simulation
    runs: Sequence[PrecisionRun]
    sharp: Sequence[PrecisionRun]
    coarse: Sequence[PrecisionRun]
    meshed: Sequence[PrecisionRun]
    variants: Sequence[str]
    wanted: Sequence[str]
    least: Mapping[str, float]

    def carry_out(self, repeats: int, progress: bool | None) -> None:
        """Run everything once, the scene as given before its other models, then what is repeated in turn.

        A model that takes too many steps at a tolerance is not run at stricter ones.
        """
        timed = [*self.runs, *self.coarse]
        once = [*timed, *self.sharp, *self.meshed]
        once.sort(key=lambda run: run.variant != AS_GIVEN)  # keeps the order of the others
        whole = len(once) + (repeats - 1) * len(timed)
        with progress_bar(progress, "work and precision", whole) as bar:
            for run in once + (repeats - 1) * timed:
                run.once()
                refuse_stricter(run, once)
                bar(1)

    @property
    def done(self) -> int:
        """How many of the runs there are answers of."""
        return sum(bool(run.times) for run in self._all)

    @property
    def planned(self) -> int:
        """How many runs there are, without repeats."""
        return len(self._all)

    @property
    def _all(self) -> list[PrecisionRun]:
        return [*self.runs, *self.coarse, *self.sharp, *self.meshed]

    def found(self) -> WorkPrecision | None:
        """Return what the runs so far tell; ``None`` without converged values of the scene as given."""
        of_variant, rows = self._judged()
        if AS_GIVEN not in of_variant:
            return None
        if self.meshed:
            sizes = [1.0 / math.sqrt(run.simulation.scene.vehicle.n_elements) for run in self.meshed]
            limits = limits_of(self.meshed, self.wanted, self.least, sizes)
            if limits:
                of_variant["mesh"] = limits
            rows += [row_of(run, limits, self.least) for run in self.coarse]
        own = self.simulation.scene.settings
        is_default = (AS_GIVEN, "tolerance", own.tolerance)
        if own.time_step is not None:
            is_default = (AS_GIVEN, "time_step", own.time_step)
        return WorkPrecision(
            title=_title(self.simulation),
            rows=rows,
            of_variant=of_variant,
            scales={n: max(abs(limit.value), self.least[n]) for n, limit in of_variant[AS_GIVEN].items()},
            default=next(row for row in rows if (row.variant, row.kind, row.value) == is_default),
        )

    def _judged(self) -> tuple[dict[str, dict[str, Limit]], list[PrecisionRow]]:
        """Return the converged values of each variant, and a row for each run with its errors."""
        of_variant, rows = {}, []
        for variant in self.variants:
            mine = [run for run in self.runs if run.variant == variant]
            sharp = [run for run in self.sharp if run.variant == variant]
            finest = [run for run in mine if run.kind == "tolerance"][-1:]
            limits = limits_of(finest + sharp, self.wanted, self.least)
            if limits:
                of_variant[variant] = limits
            mine += [replace(run, kind="reference") for run in sharp]
            rows += [row_of(run, limits, self.least) for run in mine]
        return of_variant, rows

    def first_refusal(self) -> str:
        """Return why there is no converged answer of the scene as given."""
        refused = (run.refused for run in self.sharp if run.refused)
        return next(refused, "its metrics differ from one to the next")


def _title(simulation: Simulation) -> str:
    scene = simulation.scene
    return (
        f"{scene.vehicle.title} ({scene.vehicle.n_nodes} nodes), {barrier_text(scene.barrier)}, "
        f"{scene.impact_speed:g} m/s, {scene.impact_angle:g}°{pose_text(scene)}"
    )
