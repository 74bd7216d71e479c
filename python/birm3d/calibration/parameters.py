"""What a calibration may change, and by how much."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..base.arguments import check_fields
from ..base.checks import number, pair
from ..simulation.parameters import quantity_of, unit_of, value_of, varied
from ..units import Quantity, si

if TYPE_CHECKING:
    from ..simulation.simulation import Simulation

__all__ = ["Parameter", "ParameterSet", "unit_of_values"]

Floats = npt.NDArray[np.float64]


def unit_of_values(names: Sequence[str], factor: bool) -> str:
    """Return the SI unit of a parameter that drives the numbers `names`; ``""`` of a factor or a function."""
    return "" if factor or not names else unit_of(names[0])


@dataclass(frozen=True)
class Parameter:
    """One unknown of a calibration; it may drive several numbers of several scenes.

    Parameters
    ----------
    names
        Number of the scene, or several, named as in :mod:`birm3d.scene_parameters`. All of them get the same
        value, or with ``factor`` are multiplied by it.
    lower, upper
        Bounds, both given and finite; as ``start`` and ``prior`` also text with a unit, as ``"1500 kg"``.
        They also say what "wide" means: a parameter whose interval is as wide as its bounds counts as not
        identified.
    start
        ``None``: the present value (of the first name in the first scene), 1 with ``factor``.
    log
        Whether steps, starts and intervals are taken in the logarithm; for stiffnesses. Needs lower > 0.
    prior
        Mean and standard deviation of what is known beforehand; with ``log`` of a log-normal whose median is
        the mean and whose logarithm has the deviation sigma / mean.
    factor
        Whether the value multiplies what the scenes have.
    simulations
        Indices of the simulations that it drives; ``None``: all.
    apply
        ``apply(simulation, value) -> simulation`` for what has no name of its own; needs ``name`` and
        ``start``. For an executor of processes it must be a function of a module.
    name
        For reports; ``None``: the first of ``names``.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value received.
    """

    names: str | Sequence[str] = ()
    lower: float = math.nan
    upper: float = math.nan
    start: float | None = None
    log: bool = False
    prior: tuple[float, float] | None = None
    factor: bool = False
    simulations: Sequence[int] | None = None
    apply: Callable[[Simulation, float], Simulation] | None = None
    name: str | None = None

    if TYPE_CHECKING:  # what dataclass makes, and the text that __post_init__ reads

        def __init__(
            self,
            names: str | Sequence[str] = (),
            lower: Quantity = math.nan,
            upper: Quantity = math.nan,
            start: Quantity | None = None,
            log: bool = False,
            prior: tuple[Quantity, Quantity] | None = None,
            factor: bool = False,
            simulations: Sequence[int] | None = None,
            apply: Callable[[Simulation, float], Simulation] | None = None,
            name: str | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        check_fields(self, texts=("lower", "upper", "start", "prior"))
        names = (self.names,) if isinstance(self.names, str) else tuple(self.names)
        object.__setattr__(self, "names", names)
        if bool(names) == (self.apply is not None):
            raise ValueError(
                f"names must be given, or apply, not both; got names {names} and apply {self.apply}"
            )
        if self.apply is not None and (self.name is None or self.start is None):
            raise ValueError(f"name and start must be given with apply, got {self.name!r} and {self.start}")
        for key in ("lower", "upper", "start"):
            object.__setattr__(self, key, self._in_si(key, getattr(self, key)))
        if self.prior is not None:
            object.__setattr__(self, "prior", tuple(self._in_si("prior", one) for one in self.prior))
        check_fields(self)
        if self.simulations is not None:
            object.__setattr__(self, "simulations", tuple(int(i) for i in self.simulations))
        for bound in ("lower", "upper"):
            if not math.isfinite(getattr(self, bound)):
                raise ValueError(f"{bound} of {self.label} must be finite, got {getattr(self, bound)}")
        if not self.lower < self.upper:
            raise ValueError(
                f"lower of {self.label} must be below upper, got {self.lower:g} and {self.upper:g}"
            )
        if self.log and not self.lower > 0.0:
            raise ValueError(f"lower of {self.label} must be > 0 with log, got {self.lower:g}")
        if self.start is not None:
            self.check_start(self.start)
        if self.prior is not None:
            mean, sigma = pair(f"prior of {self.label}", self.prior)
            if not (math.isfinite(mean) and (mean > 0.0 or not self.log)):
                limit = "finite and > 0 with log" if self.log else "finite"
                raise ValueError(f"prior mean of {self.label} must be {limit}, got {mean}")
            if not (math.isfinite(sigma) and sigma > 0.0):
                raise ValueError(f"prior sigma of {self.label} must be finite and > 0, got {sigma}")

    def _in_si(self, key: str, value: Quantity | None) -> float | None:
        """Return a number that may be given as text with the unit of the first name."""
        if not isinstance(value, str):
            return value if value is None else number(f"{key} of {self.label}", value)
        quantity = quantity_of(self.names[0]) if self.names and not self.factor else None
        if quantity is None:
            raise ValueError(f"{key} of {self.label} must be a number, got {value!r}")
        return si(f"{key} of {self.label}", value, quantity)

    @property
    def unit(self) -> str:
        """SI unit of the value; ``""`` of a factor or a function."""
        return unit_of_values(tuple(self.names), self.factor)

    @property
    def label(self) -> str:
        """Name for reports."""
        return self.name or (self.names[0] if self.names else "parameter")

    def check_start(self, start: float) -> float:
        """Return a start, or raise if it is outside the bounds."""
        if not self.lower <= start <= self.upper:
            raise ValueError(
                f"start of {self.label} must be within its bounds {self.lower:g} to {self.upper:g}, "
                f"got {start:g}"
            )
        return float(start)

    def drives(self, index: int) -> bool:
        """Whether it changes simulation number `index`."""
        return self.simulations is None or index in self.simulations

    @property
    def span(self) -> float:
        """Distance of the bounds, in the logarithm with ``log``."""
        return self._inner(self.upper) - self._inner(self.lower)

    def to_unit(self, value: float) -> float:
        """Return a value as a share of the way between the bounds, 0 to 1."""
        return (self._inner(value) - self._inner(self.lower)) / self.span

    def from_unit(self, share: float) -> float:
        """Return the value at a share of the way between the bounds; the inverse of :meth:`to_unit`."""
        inner = self._inner(self.lower) + share * self.span
        return math.exp(inner) if self.log else inner

    def slope(self, value: float) -> float:
        """Return d value / d share."""
        return self.span * (value if self.log else 1.0)

    def difference_step(self, value: float, relative: float) -> float:
        """Return a step of finite differences as a share: `relative` times the size of the value.

        The size of a value that may be near zero is at least a tenth of the distance of its bounds.
        """
        size = 1.0 if self.log else max(abs(value), 0.1 * self.span)
        return min(relative * size / self.span, 0.05)

    def prior_row(self, share: float) -> tuple[float, float]:
        """Return the prior's residual at a share and its derivative by the share."""
        assert self.prior is not None
        mean, sigma = self.prior
        inner_sigma = sigma / mean if self.log else sigma
        return (
            (self._inner(self.lower) + share * self.span - self._inner(mean)) / inner_sigma,
            self.span / inner_sigma,
        )

    def _inner(self, value: float) -> float:
        return math.log(value) if self.log else value


class ParameterSet:
    """All parameters of a calibration, and the scenes as they were.

    Raises
    ------
    ValueError
        For unknown names, numbers that two parameters drive, starts outside bounds, simulations that do not
        exist.
    """

    def __init__(self, parameters: Sequence[Parameter], simulations: Sequence[Simulation]) -> None:
        if not parameters:
            raise ValueError("parameters must hold at least one Parameter, got none")
        self.parameters = tuple(parameters)
        driven: dict[tuple[int, str], str] = {}
        labels: set[str] = set()
        base: list[dict[str, float]] = [{} for _ in simulations]
        starts = []
        for parameter in self.parameters:
            if not isinstance(parameter, Parameter):
                raise TypeError(
                    f"parameters must be birm3d.calibration.Parameter, got {type(parameter).__name__}"
                )
            if parameter.label in labels:
                raise ValueError(f"name of a parameter must be its own, got {parameter.label!r} twice")
            labels.add(parameter.label)
            for index in parameter.simulations or ():
                if not 0 <= index < len(simulations):
                    raise ValueError(
                        f"simulations of {parameter.label} must be 0 to {len(simulations) - 1}, got {index}"
                    )
            chosen = [i for i in range(len(simulations)) if parameter.drives(i)]
            for i in chosen:
                for name in parameter.names:
                    base[i][name] = _number(name, value_of(simulations[i], name))
                    other = driven.setdefault((i, name), parameter.label)
                    if other != parameter.label:
                        raise ValueError(
                            f"{name} must be driven by one parameter, got {other} and {parameter.label}"
                        )
            start = parameter.start
            if start is None:
                start = 1.0 if parameter.factor else base[chosen[0]][parameter.names[0]]
            starts.append(parameter.check_start(start))
        self.base = tuple(base)
        self.start: Floats = np.array(starts)

    def __len__(self) -> int:
        return len(self.parameters)

    @property
    def labels(self) -> tuple[str, ...]:
        """Names for reports."""
        return tuple(parameter.label for parameter in self.parameters)

    def to_unit(self, values: Sequence[float] | Floats) -> Floats:
        """Return values as shares, shape (p,)."""
        return np.array([p.to_unit(float(v)) for p, v in zip(self.parameters, values, strict=True)])

    def from_unit(self, shares: Sequence[float] | Floats) -> Floats:
        """Return shares as values, shape (p,)."""
        return np.array([p.from_unit(float(u)) for p, u in zip(self.parameters, shares, strict=True)])

    def changed(self, simulation: Simulation, index: int, values: Floats) -> Simulation:
        """Return simulation number `index` with the parameters at `values`, shape (p,)."""
        changes: dict[str, Any] = {}
        for parameter, value in zip(self.parameters, values.tolist(), strict=True):
            if parameter.drives(index):
                for name in parameter.names:
                    changes[name] = value * self.base[index][name] if parameter.factor else value
        if changes:
            simulation = varied(simulation, changes)
        for parameter, value in zip(self.parameters, values.tolist(), strict=True):
            if parameter.apply is not None and parameter.drives(index):
                simulation = parameter.apply(simulation, value)
        return simulation


def applied(
    parameters: Sequence[Mapping[str, Any]], values: Mapping[str, float], simulation: Simulation
) -> Simulation:
    """Return a simulation with stored parameters at their values."""
    changes: dict[str, Any] = {}
    for parameter in parameters:
        if not parameter["names"]:
            raise ValueError(
                f"parameter {parameter['label']!r} must have names to be applied to another "
                "simulation, got a function"
            )
        for name in parameter["names"]:
            value = values[parameter["label"]]
            changes[name] = value * value_of(simulation, name) if parameter["factor"] else value
    return varied(simulation, changes)


def _number(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"parameter {name} must be a number, got {value!r}")
    return float(value)
