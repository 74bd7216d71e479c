"""Design loads: what each element of a barrier has to carry, over all impacts that it is designed for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..barrier.kinds import Bollards
from ..barrier.text import barrier_text
from ..base.arguments import checked
from ..base.complaints import Complaint
from ..result.result import Result
from ..result.run_warnings import doubts_of
from ..simulation.simulation import Simulation
from ..study.predict import Prediction
from ..study.table import Study
from ..units import Quantity
from .class_bands import Bands, Seen, bands_of, class_draws, governing_scenes, with_bands
from .design_caution import has_blow, merged, run_cautions
from .design_plan import DesignPlan, design_plan, predicted_scene
from .design_remarks import design_cautions
from .design_table import DesignLoad, LoadScene
from .element_demand import element_design
from .element_design import ElementDesign, System, peak_filter
from .element_envelope import envelope
from .impact_end import end_of_impact

__all__ = [
    "DesignLoadInterrupted",
    "design_load",
    "looker",
    "with_vehicles",
]

Floats = npt.NDArray[np.float64]

_NO_BAND = " No band: "
_ONE_VEHICLE = " Loads are those of this vehicle: others of its class may ask for more."


class DesignLoadInterrupted(KeyboardInterrupt):
    """Ctrl-C; ``design_load`` is the envelope over the finished scenes, ``None`` if there are none."""

    def __init__(self, message: str, design_load: DesignLoad | None) -> None:
        super().__init__(message)
        self.design_load = design_load

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.args[0], self.design_load))


class _Found(NamedTuple):
    """What one run adds to the envelope."""

    rows: list[ElementDesign]
    cautions: dict[str, tuple[str, ...]]
    doubts: tuple[Complaint, ...]


@checked
def design_load(
    cases: Simulation | Result | Study | Prediction | Sequence[Simulation | Result],
    *,
    natural_period: Quantity | None = None,
    ductility: float = 1.0,
    damping: float = 0.0,
    offsets: Iterable[Quantity] | None = None,
    impact_angles: Iterable[Quantity] | None = None,
    impact_speeds: Iterable[Quantity] | None = None,
    quantile: float = 1.0,
    draws: int | None = None,
    executor: Any = None,
    progress: bool | None = None,
) -> DesignLoad:
    """Return what each post, segment or panel of a barrier has to carry: a table for the structural engineer.

    For each element: impulse, peak force (CFC 60), greatest 50-ms means of the force with its height, of the
    force along the barrier and of the moment at the foot; equivalent static force and moment. With several
    scenes each value is the greatest of all, and the table names the scene that the value of this vehicle
    comes from.

    The equivalent static force is that of a system with one degree of freedom under the unfiltered load
    (Biggs, Introduction to Structural Dynamics, 1964). At ductility 1 it is m w^2 max|u|, the peak force
    times the dynamic load factor. Above, it is the resistance R of the elastic-plastic system for which
    max|u| = ductility R / (m w^2). See :mod:`birm3d.assessment.oscillator`. The equivalent static moment is
    made in the same way from the moment about the foot, for a system that turns about it. A post that could
    yield and has not counts as elastic.

    Of a post that yields in the run the equivalent static force follows from statics: it is the moment that
    tube or foundation resists, divided by the arm. The arm is the height of the 50-ms force above the point
    about which the post turns. That is the capacity design of foundations, as in
    EN 1998-1, 4.4.2.6, without its factor for overstrength. The run has spent the yielding already, so that
    natural period and ductility do not change this force. It is at most twice the peak force, as no single
    pulse has a greater dynamic load factor.

    Parameters
    ----------
    cases
        A scene, or several at the same barrier, as of several vehicles; results are taken as they are. Of a
        study, as one of :func:`birm3d.monte_carlo`, all runs that did not fail. Of a prediction its scene,
        with as many draws as it has.
    natural_period
        Of an element on its foundation [s]; at least 4 output intervals. ``None``: 0.1 s is assumed, and the
        caution says so. It has no effect on posts that yield.
    ductility
        Displacement over yield displacement that the element may reach, 1 (elastic) to 100; without effect on
        posts that yield.
    damping
        Ratio to the critical one, >= 0 and < 1.
    offsets, impact_angles, impact_speeds
        Lists of ``impact_offset`` [m], ``impact_angle`` [deg] and ``impact_speed`` [m/s], or texts with
        units: each scene is run with all combinations. ``None``: the scene's own.
    quantile
        Which value of all scenes counts, > 0 and <= 1: 1 is the greatest, 0.9 the one that 90 % of the scenes
        do not exceed. It is that of a scene, which the table names.
    draws
        Vehicles of the class that give each value its 80 % band, a power of 2, or 0; each is run in the
        scenes that govern. They are those of :func:`birm3d.predict`. ``None``: 16, where the vehicle's file
        says how its class scatters; none of a study, whose runs differ already.
    executor
        Any :class:`concurrent.futures.Executor`, or a ``dask.distributed.Client``; ``None``: a thread for
        each core of the machine.
    progress
        Bar on stderr; ``None``: if that is a terminal, and in notebooks.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; if there is no barrier, the barriers differ, or no scene
        can be run.
    DesignLoadInterrupted
        A KeyboardInterrupt, with the envelope over the finished scenes.
    RuntimeError
        If the executor dies.

    Examples
    --------
    >>> loads = birm3d.design_load(sim, natural_period=0.05, ductility=3, offsets=[0.0, 0.3, 0.6])
    >>> print(loads.to_markdown())
    """
    # What only studies need, such as multiprocessing, is loaded by the first one.
    from ..study.executors import ExecutorError

    if isinstance(cases, Prediction):
        cases, draws = predicted_scene(cases, draws)
    refusal = "the runs of a study differ already" if isinstance(cases, Study) else ""
    lists = {"impact_offset": offsets, "impact_angle": impact_angles, "impact_speed": impact_speeds}
    plan = design_plan(cases, lists, quantile, natural_period, ductility, damping)
    drawn = class_draws(plan.scenes, draws, refusal)
    seen = _Envelope(plan)
    try:
        seen.look_at_all(executor, progress)
    except KeyboardInterrupt:
        message = f"stopped: {len(seen.found)} of {len(plan.scenes)} scenes are finished, their envelope is "
        message += "kept in the error's 'design_load'"
        raise DesignLoadInterrupted(message, seen.table() if seen.found else None) from None
    except ExecutorError as died:
        cause = died.__cause__
        raise RuntimeError(f"the executor died ({type(cause).__name__}: {cause})") from cause
    if not seen.found:
        reason = seen.failed[min(seen.failed)]
        raise ValueError(f"cases must have a scene that can be run, got none: {reason}")
    load = seen.table()
    if drawn.power is None:
        load.caution += f"{_NO_BAND}{drawn.reason}.{'' if refusal else _ONE_VEHICLE}"
        return load
    scenes = {run: plan.scenes[run] for run in governing_scenes(load)}
    rows = partial(_rows_and_blow, normal=load.normal, system=plan.system)
    bands = with_bands(load.rows, scenes, drawn.power, rows, executor=executor, progress=progress)
    return _with(load, bands, drawn.vehicles)


class _Envelope:
    """What was found in the scenes of a plan so far, and their envelope."""

    def __init__(self, plan: DesignPlan) -> None:
        self.plan = plan
        self.found: dict[int, _Found] = {}
        self.failed: dict[int, str] = {}

    def look_at_all(self, executor: Any, progress: bool | None) -> None:
        """Evaluate the results that are there; run and evaluate all other scenes."""
        from ..study.whole_runs import look_at_runs

        plan = self.plan
        look = partial(_look, normal=plan.normal, system=plan.system)
        for run, case in enumerate(plan.cases):
            if isinstance(case, Result):
                self.found[run] = look(case)
        runs = [run for run, case in enumerate(plan.cases) if not isinstance(case, Result)]
        scenes = [plan.scenes[run] for run in runs]
        for seen in look_at_runs(scenes, look, executor=executor, progress=progress, title="design loads"):
            if seen.found is None:
                self.failed[runs[seen.run]] = seen.error
            else:
                self.found[runs[seen.run]] = seen.found

    def table(self) -> DesignLoad:
        """Return the table over the scenes that are finished, without bands."""
        plan, sources = self.plan, self.plan.sources
        rows_of_run = {run: self.found[run].rows for run in sorted(self.found)}
        elements = range(len(plan.barrier.element_names))
        load = DesignLoad(
            tuple(
                envelope({run: rows[i] for run, rows in rows_of_run.items()}, sources, plan.quantile)
                for i in elements
            ),
            plan.system,
            peak_filter=peak_filter(max(scene.settings.output_interval for scene in plan.scenes)),
            scenes=tuple(LoadScene.of(scene) for scene in plan.scenes),
            failed=self.failed,
            barrier=barrier_text(plan.barrier),
            normal=plan.normal,
            caution="",
            finished=len(self.found),
            quantile=plan.quantile,
        )
        found = [self.found[run] for run in sorted(self.found)]
        rows = [row for one in found for row in one.rows]
        of_runs = merged((one.cautions for one in found), (doubt for one in found for doubt in one.doubts))
        cautions = design_cautions(load, plan, rows, of_runs)
        load.caution = " ".join(dict.fromkeys(cautions))
        return load


def _look(result: Result, normal: Floats, system: System) -> _Found:
    return _Found(_rows_of(result, normal, system), run_cautions(result), doubts_of(result))


def _rows_of(result: Result, normal: Floats, system: System) -> list[ElementDesign]:
    end = end_of_impact(result)
    barrier = result.scene.barrier
    weaker = barrier.weaker if isinstance(barrier, Bollards) else None
    yielded = np.zeros(len(result.element_loads), bool)
    tilt = result.post_tilt
    yielded[: tilt.shape[1]] = (tilt > 0.0).any(axis=0)
    return [
        element_design(load, normal, system, end, weaker, bool(has))
        for load, has in zip(result.element_loads, yielded, strict=True)
    ]


def _rows_and_blow(result: Result, normal: Floats, system: System) -> Seen:
    return _rows_of(result, normal, system), has_blow(result)


def looker(load: DesignLoad) -> Callable[[Result], Seen]:
    """Return what tells of a run what each element carries, and whether the rigid body strikes one."""
    system = System(load.natural_period, load.ductility, load.damping)
    return partial(_rows_and_blow, normal=load.normal, system=system)


def with_vehicles(load: DesignLoad, seen: Iterable[tuple[int, Seen | None]], vehicles: int) -> DesignLoad:
    """Return the design loads of one scene, made without draws, with the bands of vehicles that were run.

    Parameters
    ----------
    load
        Changed, too.
    seen, vehicles
        See :func:`birm3d.assessment.class_bands.bands_of`.
    """
    load.caution = load.caution.partition(_NO_BAND)[0]  # that there is no band is said last
    return _with(load, bands_of(load.rows, seen, vehicles), vehicles)


def _with(load: DesignLoad, bands: Bands, vehicles: int) -> DesignLoad:
    load.rows, load.draws = bands.rows, vehicles
    load.caution = " ".join([load.caution, *bands.cautions])
    return load
