"""Design loads: what each element of a barrier has to carry, over all impacts that it is designed for."""

# Longer than 300 lines: the envelope over all scenes, and its bands over the vehicles of the class.
from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..barrier.base import Barrier
from ..barrier.text import barrier_text
from ..base.arguments import checked
from ..base.checks import check_runs, number
from ..result.result import Result
from ..simulation.parameters import in_si, varied_scene
from ..simulation.simulation import Simulation
from ..study.predict import Prediction
from ..study.table import Study
from ..unit_check import given, warn_if_any_unusual
from ..units import Quantity
from .class_bands import Bands, Seen, bands_of, class_draws, governing_scenes, with_bands
from .design_caution import barrier_caution, has_blow, merged, run_cautions
from .design_table import DesignLoad, LoadScene
from .element_design import (
    ElementDesign,
    System,
    check_system,
    element_design,
    envelope,
    peak_filter,
)
from .oscillator import LEAST_INTERVALS

__all__ = [
    "ASSUMED",
    "DesignLoadInterrupted",
    "design_load",
    "greatest_of_periods",
    "looker",
    "with_vehicles",
]

Floats = npt.NDArray[np.float64]

_ASSUMED_PERIOD = 0.1  # s
ASSUMED = f"The natural period of {_ASSUMED_PERIOD:g} s is assumed: give that of the element."
"""Caution where no natural period was given."""
_PERIODS, _POINTS = (0.03, 0.3), 31  # s: about a third to three times the period that is assumed
_NO_BAND = " No band: "
_MOST_OF_ONE_PULSE = 2.0  # no single pulse has a greater dynamic load factor


_ADDED = (
    "A dynamic load factor above 2 comes from blows that follow each other while the element swings, or from "
    "peaks that the filter of the peak force takes: damping lessens the first. On a wall that is one element "
    "blows at distant places add up: give it segments."
)


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

    For each element: impulse, peak force (CFC 60), greatest 50-ms mean force with its height, design moment
    at the foot, and the equivalent static force. With several scenes each value is the greatest of all, and
    the table names the scene that it comes from.

    The equivalent static force is that of a system with one degree of freedom under the unfiltered load
    (Biggs, Introduction to Structural Dynamics, 1964). At ductility 1 it is m w^2 max|u|, the peak force
    times the dynamic load factor. Above, it is the resistance R of the elastic-plastic system for which
    max|u| = ductility R / (m w^2). See :mod:`birm3d.assessment.oscillator`.

    Parameters
    ----------
    cases
        A scene, or several at the same barrier, as of several vehicles; results are taken as they are. Of a
        study, as one of :func:`birm3d.monte_carlo`, all runs that did not fail. Of a prediction its scene,
        with as many draws as it has.
    natural_period
        Of an element on its foundation [s]; at least 4 output intervals. ``None``: 0.1 s is assumed, and the
        caution says so.
    ductility
        Displacement over yield displacement that the element may reach, 1 (elastic) to 100.
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
    # Longer than 60 lines: an envelope over what is finished is kept whichever way the runs stop.
    # What only studies need, such as multiprocessing, is loaded by the first one.
    from ..study.executors import ExecutorError
    from ..study.whole_runs import look_at_runs

    if isinstance(cases, Prediction):
        cases, draws = _predicted(cases, draws)
    listed = _listed(cases)
    if not 0.0 < quantile <= 1.0:
        raise ValueError(f"quantile must be > 0 and <= 1, got {quantile}")
    lists = {"impact_offset": offsets, "impact_angle": impact_angles, "impact_speed": impact_speeds}
    varied = {name: _values(name, values) for name, values in lists.items() if values is not None}
    barrier = _common_barrier(listed, varied)
    system = _system(listed, natural_period, ductility, damping)
    check_runs("cases", len(listed) * math.prod(map(len, varied.values())))
    plan = [
        (case, varied_scene(case.scene, dict(zip(varied, row, strict=True))))
        for case in listed
        for row in itertools.product(*varied.values())
    ]
    refusal = "the runs of a study differ already" if isinstance(cases, Study) else ""
    drawn = class_draws((scene for _, scene in plan), draws, refusal)
    sources = [case if isinstance(case, Result) else scene for case, scene in plan]
    look = partial(_look, normal=-np.asarray(barrier.core.normal), system=system)
    found: dict[int, _Found] = {}
    failed: dict[int, str] = {}
    general = barrier_caution(barrier)
    if natural_period is None:
        general.append(ASSUMED)

    def table() -> DesignLoad:
        runs = sorted(found)
        elements = range(len(barrier.element_names))
        least = 0.01 * max(row.peak_force for run in runs for row in found[run].rows)
        cautions = merged(found[run].cautions for run in runs)
        if any(
            row.dynamic_load_factor > _MOST_OF_ONE_PULSE
            for run in runs
            for row in found[run].rows
            if row.peak_force > least
        ):
            cautions.append(_ADDED)
        load = DesignLoad(
            tuple(envelope({run: found[run].rows[i] for run in runs}, sources, quantile) for i in elements),
            system,
            peak_filter=peak_filter(max(scene.settings.output_interval for _, scene in plan)),
            scenes=tuple(LoadScene.of(scene) for _, scene in plan),
            failed=failed,
            barrier=barrier_text(barrier),
            normal=-np.asarray(barrier.core.normal),
            caution="",
            finished=len(found),
            quantile=quantile,
        )
        beyond = _of_other_periods(load) if natural_period is None else ()
        load.caution = " ".join(dict.fromkeys([*general, *beyond, *cautions, *_at_ends(load, varied)]))
        return load

    def banded(load: DesignLoad) -> DesignLoad:
        if drawn.power is None:
            load.caution += f"{_NO_BAND}{drawn.reason}."
            return load
        scenes = {number: plan[number][1] for number in governing_scenes(load)}
        rows = partial(_rows_and_blow, normal=load.normal, system=system)
        bands = with_bands(load.rows, scenes, drawn.power, rows, executor=executor, progress=progress)
        return _with(load, bands, drawn.vehicles)

    try:
        for run, result in enumerate(case for case, _ in plan):
            if isinstance(result, Result):
                found[run] = look(result)
        runs = [run for run, (case, _) in enumerate(plan) if not isinstance(case, Result)]
        scenes = [plan[run][1] for run in runs]
        for seen in look_at_runs(scenes, look, executor=executor, progress=progress, title="design loads"):
            if seen.found is None:
                failed[runs[seen.run]] = seen.error
            else:
                found[runs[seen.run]] = seen.found
    except KeyboardInterrupt:
        message = f"stopped: {len(found)} of {len(plan)} scenes are finished, their envelope is kept in the "
        message += "error's 'design_load'"
        raise DesignLoadInterrupted(message, table() if found else None) from None
    except ExecutorError as died:
        cause = died.__cause__
        raise RuntimeError(f"the executor died ({type(cause).__name__}: {cause})") from cause
    if not found:
        raise ValueError(f"cases must have a scene that can be run, got none: {failed[min(failed)]}")
    return banded(table())


def _predicted(prediction: Prediction, draws: int | None) -> tuple[Simulation, int]:
    """Return the scene of a prediction and the number of its draws."""
    study = prediction.study
    if study._scene is None:
        raise ValueError("cases must be a prediction that knows its scene, got one of a file")
    return Simulation.from_scene(study._scene), len(study) if draws is None else draws


def _listed(cases: Simulation | Result | Study | Sequence[Simulation | Result]) -> list[Simulation | Result]:
    if isinstance(cases, (Simulation, Result)):
        return [cases]
    if isinstance(cases, Study):
        return [cases.simulation(row) for row, error in enumerate(cases.error) if not error]
    return list(cases)


def _look(result: Result, normal: Floats, system: System) -> _Found:
    return _Found(_rows_of(result, normal, system), run_cautions(result))


def _rows_of(result: Result, normal: Floats, system: System) -> list[ElementDesign]:
    separation = result.metrics.get("time_of_separation", math.inf)
    return [element_design(load, normal, system, separation) for load in result.element_loads]


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
    load.caution = load.caution.partition(_NO_BAND)[0]  # that there is no band was the last sentence
    return _with(load, bands_of(load.rows, seen, vehicles), vehicles)


def _with(load: DesignLoad, bands: Bands, vehicles: int) -> DesignLoad:
    load.rows, load.draws = bands.rows, vehicles
    load.caution = " ".join([load.caution, *bands.cautions])
    return load


def _values(name: str, values: Iterable[Quantity]) -> list[float]:
    stated = list(values)
    warn_if_any_unusual(name, stated)
    found = [number(name, in_si(name, value)) for value in stated]
    if not found:
        raise ValueError(f"{name} must have at least one value, got an empty list")
    for value in found:
        if not math.isfinite(value):
            raise ValueError(f"{name} must be finite, got {value}")
    return found


def _common_barrier(cases: Sequence[Simulation | Result], varied: Iterable[str]) -> Barrier:
    if not cases:
        raise ValueError("cases must be at least one Simulation or Result, got an empty list")
    barrier = cases[0].scene.barrier
    if barrier is None:
        raise ValueError("cases must have a barrier, got one without")
    for case in cases:
        if case.scene.barrier != barrier:
            raise ValueError(f"cases must have the same barrier, got {barrier} and {case.scene.barrier}")
        if varied and isinstance(case, Result):
            raise ValueError(f"cases must be simulations to vary {', '.join(varied)}, got a Result")
    return barrier


def _system(
    cases: Sequence[Simulation | Result], natural_period: Quantity | None, ductility: float, damping: float
) -> System:
    period = _ASSUMED_PERIOD if natural_period is None else given("natural_period", natural_period)
    system = System(float(period), float(ductility), float(damping))
    check_system(system, max(case.scene.settings.output_interval for case in cases))
    return system


def _of_other_periods(load: DesignLoad) -> Iterator[str]:
    """Yield what the governing element carries at other periods than the one that was assumed."""
    found = greatest_of_periods(load)
    if found is not None:
        force, period = found
        yield (
            f"With natural periods from {_PERIODS[0]:g} to {_PERIODS[1]:g} s, {load.governing.name} carries "
            f"up to {force / 1e3:,.0f} kN (at {period:.2g} s)."
        )
        if force > _MOST_OF_ONE_PULSE * load.governing.peak_force:
            yield _ADDED


def greatest_of_periods(load: DesignLoad) -> tuple[float, float] | None:
    """Return the greatest equivalent static force of the governing element [N], and its period [s].

    Over a third to three times the period that is assumed where none is given; ``None`` of one that nothing
    touches, or where the rows are too far apart.
    """
    row = load.governing
    if row.load is None or _PERIODS[0] < LEAST_INTERVALS * row.load.interval:
        return None
    periods = np.geomspace(*_PERIODS, _POINTS)
    forces = load.spectrum(periods)
    at = int(np.argmax(forces))
    return float(forces[at]), float(periods[at])


def _at_ends(load: DesignLoad, varied: Mapping[str, Sequence[float]]) -> Iterator[str]:
    """Yield of which lists the governing value is an end, beyond which it may be greater."""
    row = load.governing
    if not row.touched:
        return
    scene = load.scenes[row.scene["equivalent_static_force"]]
    for name in ("impact_offset", "impact_angle"):
        values = varied.get(name, ())
        if len(set(values)) > 1 and getattr(scene, name) in (min(values), max(values)):
            words = name.replace("_", " ")
            if not (name == "impact_angle" and scene.impact_angle == 90.0):
                yield f"The greatest load comes from the end of the list of {words}s: beyond it may be more."
