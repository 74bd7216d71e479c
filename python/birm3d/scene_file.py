"""Scene files (TOML): what ``birm3d run scene.toml`` runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator, model_validator

from . import units
from .barrier import Barrier
from .settings import Settings
from .simulation import Simulation
from .toml_document import Document, DocumentError, Strict, frozen, reject
from .vehicle import Vehicle

__all__ = ["SceneFileError", "read_scene_file"]


class SceneFileError(DocumentError):
    """A scene file that can not be used; the message gives file, line, key, limit and value."""


class _Vehicle(Strict):
    """Either a preset or a vehicle file (relative to the scene file)."""

    preset: str | None = None
    file: str | None = None
    gvw: str | None = None
    mesh_density: Annotated[float, Field(gt=0.0)] = 1.0

    @model_validator(mode="after")
    def _check(self) -> _Vehicle:
        if (self.preset is None) == (self.file is None):
            reject("", "must have either preset or file")
        return self


class _Barrier(Strict):
    kind: Literal["rigid_wall", "pole"]
    friction: Annotated[float, Field(ge=0.0)] = 0.2
    heading_deg: float = 0.0
    diameter_m: Annotated[float, Field(gt=0.0)] | None = None

    @model_validator(mode="after")
    def _check(self) -> _Barrier:
        if (self.diameter_m is not None) != (self.kind == "pole"):
            reject("diameter_m", "must be given for a pole and for nothing else")
        return self


class _Impact(Strict):
    """Quantities are text with a unit: "50 mph", "1.2 m", "24 deg"."""

    speed: str
    angle: str = "90 deg"
    offset: str = "0 m"
    standoff: str = "0 m"
    duration: str | None = None

    @field_validator("*")
    @classmethod
    def _readable(cls, value: str | None, info: ValidationInfo) -> str | None:
        if value is not None:
            units.parse(value, _QUANTITY[str(info.field_name)])
        return value

    def si(self, name: str) -> float:
        """Return a quantity in SI, angles in degrees."""
        return units.parse(getattr(self, name), _QUANTITY[name])


_QUANTITY = {"speed": "speed", "angle": "angle", "offset": "length", "standoff": "length", "duration": "time"}


class _Settings(Strict):
    time_step: float | None = None
    tolerance: float = Settings.tolerance
    output_interval: float = Settings.output_interval
    gravity: float = Settings.gravity
    ground: bool = Settings.ground
    mu_tire: float = Settings.mu_tire
    cornering_stiffness: float = Settings.cornering_stiffness
    restitution: float = Settings.restitution
    contact_model: Literal["projected", "along_truss"] = Settings.contact_model
    tire_model: Literal["slip", "skid"] = Settings.tire_model


class _Scene(Strict):
    vehicle: _Vehicle
    barrier: _Barrier | None = None
    impact: _Impact
    settings: _Settings = _Settings()


class _SceneDocument(Document):
    error = SceneFileError


def read_scene_file(path: str | Path) -> Simulation:
    """Read a scene file and return its simulation.

    Raises
    ------
    ValueError
        Naming file, line, key, limit and value of everything that is wrong.
    """
    path = Path(path)
    document = _SceneDocument(path)
    scene = document.validate(_Scene, frozen(document.data))
    gvw = None if scene.vehicle.gvw is None else units.parse(scene.vehicle.gvw, "mass")
    if scene.vehicle.preset is not None:
        vehicle = Vehicle.preset(scene.vehicle.preset, gvw=gvw, mesh_density=scene.vehicle.mesh_density)
    else:
        assert scene.vehicle.file is not None  # one of the two is given, see _Vehicle
        vehicle = Vehicle.from_file(
            path.parent / scene.vehicle.file, gvw=gvw, mesh_density=scene.vehicle.mesh_density
        )
    barrier = None
    if scene.barrier is not None:
        friction, heading = scene.barrier.friction, scene.barrier.heading_deg
        if scene.barrier.diameter_m is None:
            barrier = Barrier.rigid_wall(friction=friction, heading=heading)
        else:
            barrier = Barrier.pole(diameter=scene.barrier.diameter_m, friction=friction, heading=heading)
    impact = scene.impact
    return Simulation(
        vehicle,
        barrier,
        impact.si("speed"),
        impact.si("angle"),
        impact.si("offset"),
        standoff=impact.si("standoff"),
        duration=None if impact.duration is None else impact.si("duration"),
        settings=Settings(**dict(scene.settings)),
    )
