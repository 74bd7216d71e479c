"""The outcome of a calibration."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..base.arguments import checked
from .evaluator import Evaluator
from .parameters import applied
from .pool import threads_unless
from .problem import Problem
from .profile import Profile, profile
from .record import CalibrationRecord
from .storage import read, save
from .summary import summary

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..signals.compare import CurveComparison
    from ..simulation.simulation import Simulation
    from ..vehicle.vehicle import Vehicle

__all__ = ["CalibrationResult", "load"]

Floats = npt.NDArray[np.float64]


@checked
@dataclass(eq=False)
class CalibrationResult(CalibrationRecord):
    """Fitted values and how far they can be trusted.

    Attributes
    ----------
    parameters : tuple of FittedParameter
    targets : tuple of FittedTarget
    chi_square : float
        Sum of squared weighted residuals, priors among them.
    spread : Spread
        How residuals became intervals.
    confidence : float
        Of the intervals.
    covariance : ndarray, shape (q, q)
        Of the values of :attr:`identified`, to first order.
    correlation : ndarray, shape (q, q)
        Of the same.
    condition_number : float or None
        Of the Jacobian with the bounds as scale; ``None`` where a parameter moves nothing.
    notes : tuple of str
        What a reader should know, the doubts among it.
    doubts : tuple of str
        Why intervals say less than they seem to: pairs told apart poorly, ends at bounds, a prior's own
        interval. They are part of the verdict.
    starts : tuple of dict
        Where every start began and ended.
    history : tuple of Evaluation
        Every run, in an order that does not depend on the executor.
    profiles : dict of str to Profile
        Those computed so far.
    settings : dict
        Arguments of the fit.
    """

    # ---- what was fitted ----------------------------------------------------------------------------------

    @property
    def simulations(self) -> tuple[Simulation, ...]:
        """The simulations with the fitted values, at their own settings."""
        problem = self._loaded("simulations")
        values = np.array([parameter.value for parameter in self.parameters])
        return tuple(
            problem.parameters.changed(simulation, i, values)
            for i, simulation in enumerate(problem.originals)
        )

    @property
    def simulation(self) -> Simulation:
        """The first of :attr:`simulations`."""
        return self.simulations[0]

    @property
    def vehicle(self) -> Vehicle:
        """The fitted vehicle, of the first simulation."""
        return self.simulation.scene.vehicle

    def applied_to(self, simulation: Simulation) -> Simulation:
        """Return another simulation with the fitted values.

        Raises
        ------
        ValueError
            If a parameter is a function, or the scene has no number of its name.
        """
        stored = [{"label": p.label, "names": p.names, "factor": p.factor} for p in self.parameters]
        return applied(stored, self.values, simulation)

    def comparisons(self) -> dict[str, CurveComparison]:
        """Return measured against fitted for every curve against time: Sprague-Geers, W179, ISO 18571.

        By the target's label, with the simulation's number where there are several.
        """
        from ..signals.channel import Channel
        from ..signals.compare import compare_curves

        several = len({target.simulation for target in self.targets}) > 1
        found = {}
        for target in self.targets:
            if target.against != "time":
                continue
            label = f"{target.label} [{target.simulation}]" if several else target.label
            measured, computed = (
                Channel(name, target.x, values, target.unit, target.channel_class)
                for name, values in ((label, target.measured), ("fitted", target.computed))
            )
            found[label] = compare_curves(measured, computed)
        return found

    # ---- profiles -----------------------------------------------------------------------------------------

    def profile(self, label: str, *, executor: Executor | None = None) -> Profile:
        """Return the profile of a parameter: the least cost at each of its values, the others fitted anew.

        Kept in :attr:`profiles`. Also for a parameter without an interval: it shows why.
        """
        if label not in self.values:
            raise ValueError(f"label must be one of {', '.join(self.values)}; got {label!r}")
        fitted = self[label]
        if label not in self.profiles:
            problem = self._loaded("profile()")
            assert self._noise is not None  # comes with the problem
            index = problem.parameters.labels.index(label)
            share = problem.parameters.parameters[index].slope(fitted.value)
            error = fitted.standard_error
            with threads_unless(executor) as pool:
                self.profiles[label] = profile(
                    Evaluator(problem, pool),
                    self._noise,
                    problem.parameters.to_unit(list(self.values.values())),
                    index,
                    None if error is None else self.spread.quantile * error / share,
                    self.spread,
                    int(self.settings["max_steps"]),
                )
        return self.profiles[label]

    # ---- showing and keeping ------------------------------------------------------------------------------

    def summary(self) -> str:
        """Return values, intervals and the verdict as text."""
        return summary(self)

    def plot_fit(self) -> Figure:
        """Return a figure of measured and computed curves."""
        return pictures.plot_fit(self)

    def plot_residuals(self) -> Figure:
        """Return a figure of what the fit leaves, over the standard deviations."""
        return pictures.plot_residuals(self)

    def plot_profiles(self) -> Figure:
        """Return a figure of the profiles of all parameters; computes those that are missing."""
        for parameter in self.parameters:
            self.profile(parameter.label)
        return pictures.plot_profiles(self)

    def save(self, path: str | Path) -> None:
        """Write everything but the simulations to a JSON file; see :func:`birm3d.calibration.load`."""
        save(self, path)

    def _loaded(self, what: str) -> Problem:
        if self._problem is None:
            raise ValueError(
                f"{what} must be asked of the result of a calibration, got one read from a file: it has no "
                "simulations; applied_to(simulation) gives a fitted one"
            )
        return self._problem

    def _repr_html_(self) -> str:
        return pictures.text_html(self.summary(), self.plot_fit(), "measured and computed")

    def __repr__(self) -> str:
        told = ", ".join(f"{label}={value:.4g}" for label, value in self.values.items())
        return f"CalibrationResult({told}; {len(self.identified)} of {len(self.parameters)} identified)"


def load(path: str | Path) -> CalibrationResult:
    """Read a result that :meth:`CalibrationResult.save` wrote; it has no simulations.

    Raises
    ------
    FileFormatError
        If the file is none of these, is damaged or was changed, or is of a version that this one does not
        know.
    """
    return CalibrationResult(**read(path))
