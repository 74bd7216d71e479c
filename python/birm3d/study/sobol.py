"""Sobol indices: what share of a metric's variance each uncertain parameter makes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..base.arguments import checked
from ..base.deprecated import warn_renamed
from ..base.frozen_mapping import FrozenMapping
from ..simulation.simulation import Simulation
from .distributions import check_count, check_distributions, check_seed, quantiles, spread
from .runner import run_study
from .table import Study

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

__all__ = ["SobolDesign", "SobolIndex", "SobolIndices", "sobol"]

Floats = npt.NDArray[np.float64]

# Outputs whose range is below this share of their size are constant but for rounding.
_ROUNDING = 1e-12


class SobolIndex(NamedTuple):
    """Indices of one metric, shape (parameters,), with the half widths of their confidence intervals."""

    first: Floats
    first_confidence: Floats
    total: Floats
    total_confidence: Floats


@dataclass(frozen=True)
class SobolDesign:
    """One object for sampler and analyser, so that their settings can not disagree.

    Parameters
    ----------
    distributions
        Parameter -> frozen distribution of :mod:`scipy.stats`.
    n
        Size of the base sample, a power of 2; the design has n (parameters + 2) runs.
    seed
        Of the scrambling and of the resampling for confidence intervals.
    confidence
        Level of the intervals, 0 to 1.
    """

    distributions: Mapping[str, Any]
    n: int
    seed: int = 0
    confidence: float = 0.95

    def __post_init__(self) -> None:
        check_count("n", self.n, least=2, each=len(self.distributions) + 2)
        if self.n & (self.n - 1):
            raise ValueError(f"n must be a power of 2 (the balance of Sobol' points needs it), got {self.n}")
        check_seed(self.seed)
        if not 0.0 < self.confidence < 1.0:
            raise ValueError(f"confidence must be between 0 and 1, got {self.confidence}")

    @property
    def _problem(self) -> dict[str, Any]:
        # An array: SALib before 1.6 hands the names to pandas, which from 3.0 on takes no list.
        names = np.array(list(self.distributions), dtype=object)
        return {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}

    def sample(self) -> Floats:
        """Return the parameters of all runs, shape (n (d + 2), d): Saltelli's scheme on Sobol' points."""
        sampler = _salib("sample.sobol")
        shares = sampler.sample(self._problem, self.n, calc_second_order=False, seed=self.seed)
        inside = np.clip(shares, 2.0**-53, 1.0 - 2.0**-53)
        columns = [quantiles(name, d, inside[:, i]) for i, (name, d) in enumerate(self.distributions.items())]
        return np.column_stack(columns)

    def analyze(self, values: Floats) -> SobolIndex:
        """Return the indices of an output, shape (n (d + 2),), that is not constant."""
        analyzer = _salib("analyze.sobol")
        seed = self.seed + 1  # SALib takes 0 for no seed
        found = analyzer.analyze(
            self._problem, values, calc_second_order=False, conf_level=self.confidence, seed=seed
        )
        return SobolIndex(*(np.asarray(found[key], float) for key in ("S1", "S1_conf", "ST", "ST_conf")))


@checked
class SobolIndices:
    """Sobol indices of the metrics of a study.

    Attributes
    ----------
    parameters : tuple of str
    metrics : mapping of str to SobolIndex
        Of every metric that has indices.
    omitted : mapping of str to str
        Metric -> why it has none: constant, or missing from some runs.
    design : SobolDesign
    study : Study
        All runs.
    """

    def __init__(
        self,
        design: SobolDesign,
        study: Study,
        metrics: Mapping[str, SobolIndex],
        omitted: Mapping[str, str],
    ) -> None:
        self.parameters = tuple(design.distributions)
        self.design = design
        self.study = study
        self.metrics = FrozenMapping(dict(metrics))
        self.omitted = FrozenMapping(dict(omitted))

    @property
    def left_out(self) -> Mapping[str, str]:
        """Old name of ``omitted``."""
        warn_renamed("left_out", "omitted")
        return self.omitted

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table: a row for each metric and parameter; first and total order with half widths."""
        try:
            import pandas as pd
        except ImportError as error:
            raise ImportError("to_dataframe() needs pandas: pip install 'birm3d[table]'") from error
        index = pd.MultiIndex.from_product(
            [list(self.metrics), self.parameters], names=["metric", "parameter"]
        )
        columns = {
            name: np.concatenate([getattr(found, name) for found in self.metrics.values()] or [np.empty(0)])
            for name in SobolIndex._fields
        }
        return pd.DataFrame(columns, index=index)

    def plot(self, metrics: Sequence[str] | None = None) -> Figure:
        """Return bars of first and total order, a panel a metric; ``None``: of the first six."""
        return pictures.plot_sobol(self, metrics)

    def _repr_html_(self) -> str:
        return pictures.text_html(repr(self), self.plot() if self.metrics else None, "Sobol indices")

    def __repr__(self) -> str:
        omitted = "".join(f"; {name}: {reason}" for name, reason in self.omitted.items())
        return (
            f"SobolIndices({len(self.study)} runs over {', '.join(self.parameters)}; "
            f"metrics: {', '.join(self.metrics) or 'none'}{omitted})"
        )


@checked
def sobol(
    simulation: Simulation,
    distributions: Mapping[str, Any],
    n: int = 1024,
    seed: int = 0,
    *,
    confidence: float = 0.95,
    metrics: Sequence[str] | None = None,
    executor: Any = None,
    store: str | Path | None = None,
    progress: bool | None = None,
) -> SobolIndices:
    """Return first and total Sobol indices of every metric.

    First order: the share of the variance that would go if the parameter were known. Total: the share that
    would be left if all others were. Sampling and estimators: Saltelli, Annoni, Azzini, Campolongo, Ratto and
    Tarantola (2010), through SALib; intervals by bootstrap.

    Parameters
    ----------
    simulation
        The scene to vary.
    distributions
        Parameter (see :mod:`birm3d.scene_parameters`) -> frozen distribution of :mod:`scipy.stats`, SI and
        degrees; the parameters are independent.
    n
        Size of the base sample, a power of 2: n (parameters + 2) runs.
    seed
        Integer >= 0. A greater n with the same seed keeps the earlier runs.
    confidence
        Level of the intervals.
    metrics, executor, store, progress
        See :func:`birm3d.study.runner.run_study`.

    Returns
    -------
    SobolIndices
        A metric that is constant, or that some runs do not have, is in ``omitted`` with the reason.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; if a run failed (indices need all of them), with
        how many and why.
    """
    check_distributions(simulation, distributions)
    design = SobolDesign(dict(distributions), n, seed, confidence)
    study = run_study(
        simulation,
        tuple(distributions),
        design.sample().tolist(),
        metrics=metrics,
        executor=executor,
        store=store,
        progress=progress,
        title="Sobol",
    )
    if study.failed:
        reasons = Counter(study.failed.values()).most_common(3)
        listed = "; ".join(f"{count} times {reason}" for reason, count in reasons)
        raise ValueError(
            f"distributions must give runs that all succeed, for Sobol indices need every one: "
            f"{len(study.failed)} of {len(study)} failed ({listed})"
        )
    indices: dict[str, SobolIndex] = {}
    omitted: dict[str, str] = {}
    for name, values in study.metrics.items():
        missing = int(np.isnan(values).sum())
        if missing:
            omitted[name] = f"missing from {missing} of {len(study)} runs"
        elif spread(values) < _ROUNDING:
            omitted[name] = f"constant, {values[0]:g}: no variance to share"
        else:
            indices[name] = design.analyze(values)
    return SobolIndices(design, study, indices, omitted)


def _salib(module: str) -> Any:
    from importlib import import_module

    try:
        return import_module(f"SALib.{module}")
    except ImportError as error:
        raise ImportError("sobol() needs SALib: pip install 'birm3d[studies]'") from error
