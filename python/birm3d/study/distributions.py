"""Uncertain parameters: their distributions, and samples that do not depend on how many are drawn."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base.checks import check_runs, shown
from ..simulation.parameters import value_of
from ..simulation.simulation import Simulation

__all__ = ["check_distributions", "quantiles", "sample", "uniforms"]

Floats = npt.NDArray[np.float64]


def check_distributions(simulation: Simulation, distributions: Mapping[str, Any]) -> None:
    """Refuse distributions that no run can be drawn from.

    Raises
    ------
    ValueError
        If there is none, a name is unknown, or one is no frozen distribution of scipy.stats with finite
        quantiles.
    """
    if not distributions:
        raise ValueError("distributions must name at least one parameter, got none")
    for name, distribution in distributions.items():
        value_of(simulation, name)
        if not hasattr(distribution, "ppf") or not hasattr(distribution, "dist"):
            raise ValueError(
                f"distributions[{name!r}] must be a frozen distribution of scipy.stats, as norm(20, 1); "
                f"got {distribution!r}"
            )
        with np.errstate(invalid="ignore"):
            middle = np.asarray(distribution.ppf([0.25, 0.5, 0.75]), float)
        if not np.isfinite(middle).all():
            raise ValueError(
                f"distributions[{name!r}] must have finite quartiles, got {middle.tolist()} "
                f"(arguments {distribution.args}, {distribution.kwds})"
            )


def check_seed(seed: int) -> None:
    """Refuse what is no seed."""
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
        raise ValueError(f"seed must be an integer >= 0, got {shown(seed)}")


def check_count(name: str, n: int, least: int = 1, *, each: int = 1) -> None:
    """Refuse a number of samples that is none, or so many that `each` runs for each can not be held."""
    if isinstance(n, bool) or not isinstance(n, (int, np.integer)) or n < least:
        raise ValueError(f"{name} must be an integer >= {least}, got {shown(n)}")
    check_runs(name, int(n) * each, f" with {name} = {n}" if each > 1 else "")


def uniforms(name: str, n: int, seed: int) -> Floats:
    """Return n numbers, evenly distributed in (0, 1); number i depends on (seed, i, name) alone.

    Counter-based generator Philox 4x64 (Salmon, Moraes, Dror and Shaw, 2011): its key is made from seed and
    name, its counter from i.
    """
    source = np.random.Philox(np.random.SeedSequence(seed, spawn_key=tuple(name.encode())))
    raw = np.asarray(source.random_raw(n), np.uint64)
    # 52 bits and a half: never 0 nor 1, where quantiles are infinite.
    return np.asarray(((raw >> np.uint64(12)).astype(float) + 0.5) * 2.0**-52)


def quantiles(name: str, distribution: Any, shares: Floats) -> Floats:
    """Return the values below which the shares of a distribution lie, shape as `shares`."""
    values = np.asarray(distribution.ppf(shares), float)
    if not np.isfinite(values).all():
        share = float(shares[~np.isfinite(values)][0])
        raise ValueError(f"distributions[{name!r}] must have finite quantiles, got none at {share}")
    return values


def sample(distributions: Mapping[str, Any], n: int, seed: int, *, stream: str = "") -> Floats:
    """Return a sample, shape (n, len(distributions)), by inverse distribution functions.

    Row i depends on (seed, stream, i, name of the parameter) alone. So a longer sample begins with the
    shorter one, and another parameter does not change the values of this one.
    """
    columns = [quantiles(name, d, uniforms(name + stream, n, seed)) for name, d in distributions.items()]
    return np.column_stack(columns) if n else np.empty((0, len(columns)))


def spread(values: Floats) -> float:
    """Return the range of values relative to their greatest magnitude, 0 for equal ones."""
    return float(np.ptp(values)) / max(float(np.abs(values).max()), math.ulp(0.0))
