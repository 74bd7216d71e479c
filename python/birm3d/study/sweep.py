"""Sweeps: grids and lists of anything a scene has."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from ..base.arguments import checked
from ..base.checks import MOST_RUNS, check_runs, shown
from ..simulation.parameters import in_si
from ..simulation.simulation import Simulation
from ..unit_check import warn_if_any_unusual
from .runner import run_study
from .table import Study

__all__ = ["sweep"]


@checked
def sweep(
    simulation: Simulation,
    parameters: Mapping[str, Iterable[Any]] | None = None,
    *,
    mode: Literal["grid", "list"] = "grid",
    metrics: Sequence[str] | None = None,
    executor: Any = None,
    store: str | Path | None = None,
    progress: bool | None = None,
    **lists: Iterable[Any],
) -> Study:
    """Run a scene with all combinations of lists of values, or with the lists side by side.

    Parameters
    ----------
    simulation
        The scene to vary.
    parameters
        Name -> values: ``{"impact_speed": [10.0, 20.0], "barrier.friction": [0.1, 0.2]}``. See
        :mod:`birm3d.scene_parameters` for all names. Numbers are SI and degrees; text with a unit, as
        ``"30 mph"``, is taken where the parameter has one.
    mode
        ``"grid"``: all combinations, the last list fastest; ``"list"``: the first values together, then the
        second, and so on.
    metrics, executor, store, progress
        See :func:`birm3d.study.runner.run_study`.
    **lists
        The same as keywords, for names without a dot: ``impact_speed=[10, 20]`` [m/s],
        ``impact_angle=[20, 90]`` [deg], ``vehicle=["pickup", "passenger_car"]``.

    Returns
    -------
    Study
        One row a run; one that fails has its reason in ``error``.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value. Refused are an empty list, an unknown name, a NaN, lists
        of different lengths side by side, and a store of another study.

    Examples
    --------
    >>> study = birm3d.sweep(sim, {"impact_speed": [10.0, 15.0], "barrier.friction": [0.0, 0.2]})
    >>> study.to_dataframe()["dynamic_crush"]
    """
    if parameters is not None and not isinstance(parameters, Mapping):
        raise ValueError(f"parameters must be a mapping of names to lists of values, got {shown(parameters)}")
    wanted: dict[str, list[Any]] = {}
    for name, values in itertools.chain(lists.items(), (parameters or {}).items()):
        if name in wanted:
            raise ValueError(f"{name} must be given once, got it as keyword and in parameters")
        wanted[name] = _values(name, values)
    if not wanted:
        raise ValueError("parameters must name at least one to vary, as impact_speed=[10.0, 20.0]; got none")
    if mode == "list":
        lengths = {name: len(values) for name, values in wanted.items()}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"lists side by side must have equal lengths, got {lengths}")
        rows: Iterable[tuple[Any, ...]] = zip(*wanted.values(), strict=True)
    elif mode == "grid":
        sizes = [len(values) for values in wanted.values()]
        check_runs("parameters", math.prod(sizes), f" in a grid of {' x '.join(map(str, sizes))}")
        rows = itertools.product(*wanted.values())
    else:
        raise ValueError(f"mode must be 'grid' or 'list', got {mode!r}")
    return run_study(
        simulation,
        tuple(wanted),
        list(rows),
        metrics=metrics,
        executor=executor,
        store=store,
        progress=progress,
        grid=wanted if mode == "grid" else None,
        title="sweep",
    )


def _values(name: str, values: Iterable[Any]) -> list[Any]:
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise ValueError(f"{name} must be a list of values, got {values!r}")
    wanted = list(itertools.islice(values, MOST_RUNS + 1))  # an endless one ends too
    check_runs(name, len(wanted))  # before each of them is read
    warn_if_any_unusual(name, wanted)
    listed = [value if type(value) is float else in_si(name, value) for value in wanted]
    if not listed:
        raise ValueError(f"{name} must have at least one value, got an empty list")
    return listed
