"""Scene files (TOML): what ``birm3d run scene.toml`` runs."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated, Any, Literal, get_type_hints

from pydantic import Field, ValidationInfo, create_model, field_validator, model_validator

from .. import units
from ..barrier.barrier import Barrier
from ..barrier.free_standing import FreeStanding
from ..barrier.kinds import KINDS
from ..barrier.yielding import Foundation
from ..io.file_format import reads
from ..io.toml import Document, DocumentError, Strict, frozen, reject
from ..scene.settings import Settings
from ..vehicle.vehicle import Vehicle
from .simulation import Simulation

__all__ = ["SceneFileError", "read_scene_file"]


class SceneFileError(DocumentError):
    """A scene file that can not be used; the message gives file, line, key, limit and value."""


class _Vehicle(Strict):
    """Either a preset or a vehicle file (relative to the scene file)."""

    preset: str | None = None
    file: str | None = None
    gvw: str | None = None
    mesh_density: Annotated[float, Field(gt=0.0)] = 1.0
    sliding_bed: bool = False

    @model_validator(mode="after")
    def _check(self) -> _Vehicle:
        if (self.preset is None) == (self.file is None):
            reject("", "must have either preset or file")
        return self


class _FreeStanding(Strict):
    """A table in place of ``free_standing = true``; see :class:`birm3d.FreeStanding`."""

    density_kg_m3: float | None = None
    mass_per_length_kg_m: float | None = None
    ground_friction: float = FreeStanding.ground_friction
    joint: Literal["pinned", "loose"] = "pinned"

    def made(self) -> FreeStanding:
        """Return how the segments stand."""
        return FreeStanding(
            density=self.density_kg_m3,
            mass_per_length=self.mass_per_length_kg_m,
            ground_friction=self.ground_friction,
            joint=self.joint,
        )


class _Foundation(Strict):
    """The table ``foundation`` of bollards that yield; see :class:`birm3d.Foundation`."""

    moment_N_m: float  # noqa: N815  (unit)
    rotation_depth_m: float = 0.0
    mass_kg: float = 0.0

    def made(self) -> Foundation:
        """Return what holds the posts."""
        return Foundation(self.moment_N_m, self.rotation_depth_m, self.mass_kg)


class _Placed(Strict):
    """What every kind of barrier has; the sizes of the kinds are added below."""

    kind: str
    friction: Annotated[float, Field(ge=0.0)] = 0.2
    origin_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    heading_deg: float = 0.0

    @field_validator("kind")
    @classmethod
    def _known(cls, kind: str) -> str:
        if kind not in KINDS:
            reject("", f"must be one of {', '.join(KINDS)}, got {kind!r}")
        return kind

    @model_validator(mode="after")
    def _check(self) -> _Placed:
        for key in self.model_fields_set - {"kind", "friction", "origin_m", "heading_deg"}:
            if key not in _keys(self.kind):
                kinds = [kind for kind in KINDS if key in _keys(kind)]
                reject(key, f"belongs to {' or '.join(kinds)}, not to {self.kind}")
        self.made()  # refuses what the kind can not have
        return self

    def made(self) -> Barrier:
        """Return the barrier."""
        given = {
            argument: getattr(self, key)
            for key, argument in _keys(self.kind).items()
            if key in self.model_fields_set
        }
        for argument, value in given.items():
            if isinstance(value, (_FreeStanding, _Foundation)):
                given[argument] = value.made()
        barrier: Barrier = getattr(Barrier, self.kind)(
            friction=self.friction, origin=self.origin_m, heading=self.heading_deg, **given
        )
        return barrier


_SIZES = {size.key: size for kind in KINDS.values() for size in kind.sizes}
_OF_QUANTITY: dict[str, Any] = {
    "length": float | None,
    "density": float | None,
    "pressure": float | None,
    "count": int | None,
    "flag": bool | _FreeStanding,
    # A profile may be points too, and a filling its strength.
    "choice": str | float | tuple[tuple[float, float], ...] | None,
    "foundation": _Foundation | None,
}
_FIELDS: dict[str, Any] = {
    key: (_OF_QUANTITY[size.quantity], False if size.quantity == "flag" else None)
    for key, size in _SIZES.items()
}
_Barrier: type[_Placed] = create_model(
    "_Barrier",
    __base__=_Placed,
    __doc__="One of the kinds of :class:`birm3d.Barrier`; what is not given has that kind's default.",
    **_FIELDS,
)


def _keys(kind: str) -> dict[str, str]:
    """Return the keys of a kind of barrier, and the arguments of ``Barrier.<kind>()`` that they are."""
    return {size.key: size.name for size in KINDS[kind].sizes}


class _Impact(Strict):
    """Quantities are text with a unit: "50 mph", "1.2 m", "24 deg"."""

    speed: str
    angle: str = "90 deg"
    offset: str = "0 m"
    standoff: str = "0 m"
    yaw: str = "0 deg"
    roll: str = "0 deg"
    duration: str | None = None
    overlap: float | None = None
    overlap_side: Literal["left", "right"] = "left"

    @field_validator("speed", "angle", "offset", "standoff", "yaw", "roll", "duration")
    @classmethod
    def _readable(cls, value: str | None, info: ValidationInfo) -> str | None:
        if value is not None:
            _parsed(value, str(info.field_name))
        return value

    def si(self, name: str) -> float:
        """Return a quantity in SI, angles in degrees."""
        return _parsed(getattr(self, name), name)


_QUANTITY = {
    "speed": "speed",
    "angle": "angle",
    "offset": "length",
    "standoff": "length",
    "yaw": "angle",
    "roll": "angle",
    "duration": "time",
}


def _parsed(text: str, name: str) -> float:
    """Read a quantity of an impact; a speed must have its unit, others without one are SI and degrees."""
    quantity = _QUANTITY[name]
    return units.parse(text, quantity, plain=quantity != "speed")


_KINDS_OF_SETTINGS = get_type_hints(Settings)
_SETTINGS: dict[str, Any] = {
    field.name: (_KINDS_OF_SETTINGS[field.name], field.default) for field in dataclasses.fields(Settings)
}
_Settings: type[Strict] = create_model(
    "_Settings", __base__=Strict, __doc__="The fields of :class:`birm3d.Settings`.", **_SETTINGS
)


class _Scene(Strict):
    vehicle: _Vehicle
    barrier: _Barrier | None = None  # type: ignore[valid-type]
    impact: _Impact
    settings: _Settings = _Settings()  # type: ignore[valid-type]


class _SceneDocument(Document):
    error = SceneFileError


@reads("must be a scene file", SceneFileError)
def read_scene_file(path: str | Path) -> Simulation:
    """Read a scene file and return its simulation.

    Raises
    ------
    FileFormatError
        Naming file, line, key, limit and value of everything that is wrong.
    """
    path = Path(path)
    document = _SceneDocument(path)
    scene = document.validate(_Scene, frozen(document.data))
    with document.placed(("vehicle",)):
        vehicle = _vehicle(path, scene.vehicle)
    with document.placed(("barrier",)):
        barrier = None if scene.barrier is None else scene.barrier.made()
    with document.placed(("settings",)):
        settings = Settings(**dict(scene.settings))
    impact = scene.impact
    with document.placed(("impact",)):
        return Simulation(
            vehicle,
            barrier,
            impact.si("speed"),
            impact.si("angle"),
            impact.si("offset"),
            standoff=impact.si("standoff"),
            impact_yaw=impact.si("yaw"),
            impact_roll=impact.si("roll"),
            duration=None if impact.duration is None else impact.si("duration"),
            settings=settings,
            overlap=impact.overlap,
            overlap_side=impact.overlap_side,
        )


def _vehicle(path: Path, block: _Vehicle) -> Vehicle:
    gvw = None if block.gvw is None else units.parse(block.gvw, "mass")
    if block.preset is not None:
        vehicle = Vehicle.preset(block.preset, gvw=gvw, mesh_density=block.mesh_density)
    else:
        assert block.file is not None  # one of the two is given, see _Vehicle
        vehicle = Vehicle.from_file(path.parent / block.file, gvw=gvw, mesh_density=block.mesh_density)
    return vehicle.with_sliding_bed() if block.sliding_bed else vehicle
