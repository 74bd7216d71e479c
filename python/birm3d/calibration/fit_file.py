"""Fit files (TOML): what ``birm3d calibrate fit.toml`` fits."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, model_validator

from ..io.file_format import reads
from ..io.toml import Document, DocumentError, KeyPath, Strict, frozen, reject
from ..signals.readers import read_csv_channels
from ..simulation.scene_file import read_scene_file
from ..units import Quantity
from .curve_target import CurveTarget
from .parameters import Parameter
from .problem import Target
from .scalar_target import ScalarTarget

if TYPE_CHECKING:
    from ..simulation.simulation import Simulation

__all__ = ["Fit", "FitFileError", "read_fit_file"]

Positive = Annotated[float, Field(gt=0.0)]


class FitFileError(DocumentError):
    """A fit file that can not be used; the message gives file, line, key, limit and value."""


class _Curve(Strict):
    """A column of a table with units in its head; paths are relative to the fit file."""

    file: str
    column: str
    quantity: str = "normal_force"
    against_column: str | None = None
    sigma: Positive | None = None
    cfc: Positive | None = None
    filtered: bool = False
    independent_points: Positive | Literal["all"] | None = None
    weight: Positive = 1.0
    window: tuple[float, float] | None = None
    time_zero_s: float = 0.0
    turned: bool = False


class _Scalar(Strict):
    metric: str
    value: float
    sigma: Positive
    weight: Positive = 1.0


class _Simulation(Strict):
    scene: str
    curve: tuple[_Curve, ...] = ()
    scalar: tuple[_Scalar, ...] = ()

    @model_validator(mode="after")
    def _check(self) -> _Simulation:
        if not self.curve and not self.scalar:
            reject("", "must have at least one curve or scalar")
        return self


class _Parameter(Strict):
    names: tuple[str, ...]
    lower: Quantity
    upper: Quantity
    start: Quantity | None = None
    log: bool = False
    prior: tuple[Quantity, Quantity] | None = None
    factor: bool = False
    simulations: tuple[int, ...] | None = None
    name: str | None = None


class _Options(Strict):
    method: Literal["local", "global"] = "local"
    starts: Annotated[int, Field(ge=1)] = 4
    seed: Annotated[int, Field(ge=0)] = 0
    intervals: Literal["covariance", "profile"] = "covariance"
    uncertainty: Literal["larger", "given", "scatter"] = "larger"
    confidence: Annotated[float, Field(gt=0.0, lt=1.0)] = 0.95
    tolerance: Annotated[float, Field(ge=1e-9, le=0.1)] = 1e-5
    max_steps: Annotated[int, Field(ge=1)] = 50


class _Fit(Strict):
    fit: _Options = _Options()
    simulation: Annotated[tuple[_Simulation, ...], Field(min_length=1)]
    parameter: Annotated[tuple[_Parameter, ...], Field(min_length=1)]


class _FitDocument(Document):
    error = FitFileError


@dataclass
class Fit:
    """Arguments of :func:`birm3d.calibrate`."""

    simulations: list[Simulation] = field(default_factory=list)
    targets: list[list[Target]] = field(default_factory=list)
    parameters: list[Parameter] = field(default_factory=list)
    options: dict[str, Any] = field(default_factory=dict)


@reads("must be a fit file", FitFileError)
def read_fit_file(path: str | Path) -> Fit:
    """Read a fit file, its scenes and its tables.

    Raises
    ------
    FileFormatError
        Naming file, line, key, limit and value of what is wrong; of a scene file its own.
    """
    path = Path(path)
    document = _FitDocument(path)
    content = document.validate(_Fit, frozen(document.data))
    fit = Fit(options=dict(content.fit))
    for i, simulation in enumerate(content.simulation):
        key: KeyPath = ("simulation", i)
        fit.simulations.append(read_scene_file(path.parent / simulation.scene))
        goals: list[Target] = []
        for j, curve in enumerate(simulation.curve):
            with document.placed((*key, "curve", j)):
                goals.append(_curve(path, curve))
        for j, scalar in enumerate(simulation.scalar):
            with document.placed((*key, "scalar", j)):
                goals.append(ScalarTarget(**dict(scalar)))
        fit.targets.append(goals)
    for i, parameter in enumerate(content.parameter):
        with document.placed(("parameter", i)):
            fit.parameters.append(Parameter(**dict(parameter)))
    return fit


def _curve(path: Path, curve: _Curve) -> CurveTarget:
    table = path.parent / curve.file
    wanted = [curve.column] + ([curve.against_column] if curve.against_column else [])
    channels = read_csv_channels(table, wanted, cfc=curve.cfc if curve.filtered else None)
    channel = channels[curve.column]
    if curve.turned:
        channel = channel.flipped()
    options = {
        name: getattr(curve, name) for name in ("sigma", "independent_points", "weight", "window", "cfc")
    }
    if curve.against_column is None:
        return CurveTarget.from_channel(channel.shifted(curve.time_zero_s), curve.quantity, **options)
    displacement = channels[curve.against_column]
    if displacement.quantity != "length":
        raise ValueError(f"unit of {displacement.name!r} must measure length, got {displacement.unit!r}")
    target = CurveTarget.from_channel(channel, curve.quantity)  # checks the unit
    return CurveTarget(
        displacement.to_si().values,
        target.y,
        curve.quantity,
        against="displacement",
        filtered=curve.filtered,
        name=curve.column,
        **options,
    )
