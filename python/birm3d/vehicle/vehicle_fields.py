"""The fields of a vehicle: arrays, laws, and what made them."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..base.frozen_mapping import FrozenMapping
from .class_scatter import ClassScatter
from .inertia import INERTIAS
from .recipe import sums_of
from .title import title_of_name, without_mass
from .zone import Zone

if TYPE_CHECKING:
    from .file_schema import Assumption
    from .joint import Joint
    from .vehicle_file import VehicleFile
    from .vehicle_shape import VehicleShape

__all__ = ["VehicleFields"]

Floats = npt.NDArray[np.float64]

NOT_STORED: Mapping[str, Any] = {"stored": False}
"""Metadata of a field that no file holds."""


@dataclass(frozen=True, eq=False)
class VehicleFields:
    """Fields of a :class:`birm3d.Vehicle`, which says what they are."""

    name: str
    mass: float
    center_of_mass: Floats
    inertia: Floats
    nodes: Floats
    anchors: Floats
    area: Floats
    zone_of_node: npt.NDArray[np.int64]
    quads: npt.NDArray[np.int64]
    wheels: Floats
    mass_center_height: float
    zones: Mapping[str, Zone]
    rate_sensitivity: float = 0.0
    indentation_length: float = 0.0
    wheel_of_node: npt.NDArray[np.int64] = dataclasses.field(default_factory=lambda: np.empty(0, np.int64))
    along_of_node: npt.NDArray[np.int64] = dataclasses.field(default_factory=lambda: np.empty(0, np.int64))
    zone_of_wheel: npt.NDArray[np.int64] = dataclasses.field(default_factory=lambda: np.empty(0, np.int64))
    # What made the vehicle: laws per truss (m, N, N/m), or a file with its mesh density.
    _truss_laws: Floats | None = None
    _file: VehicleFile | None = None
    _shape: VehicleShape | None = dataclasses.field(default=None, compare=False, metadata=NOT_STORED)
    _mesh_density: float = 1.0
    _height: float | None = None  # of the mass centre, where one was asked for, in place of the solids' [m]
    _spread: tuple[float, float, float] | None = None  # see VehicleRecipe
    _load_density: float | None = None  # of the goods in the load space, where not the file's [kg/m^3]
    # Fields as they were made, which tell what dataclasses.replace() was given; and the names of those.
    _built: Mapping[str, Any] | None = dataclasses.field(default=None, compare=False, metadata=NOT_STORED)
    _own: tuple[str, ...] = dataclasses.field(default=(), compare=False)

    def __post_init__(self) -> None:
        n, w = len(self.nodes), len(self.wheels)
        for name, size in (("wheel_of_node", n), ("along_of_node", n), ("zone_of_wheel", w)):
            if len(getattr(self, name)) == 0:
                object.__setattr__(self, name, np.full(size, -1, np.int64))
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
        object.__setattr__(self, "zones", FrozenMapping(dict(self.zones)))

    @property
    def joint(self) -> Joint | None:
        """What joins the units; ``None`` where there is one."""
        return None

    @property
    def slides(self) -> bool:
        """Whether its load bed can slide along the frame."""
        return self.joint is not None and self.joint.kind == "sliding"

    @property
    def has_bed(self) -> bool:
        """Whether its file names a load bed, see :meth:`birm3d.Vehicle.with_sliding_bed`."""
        return self._file is not None and self._file.bed is not None

    @property
    def has_file(self) -> bool:
        """Whether the vehicle comes from a file, so that it can be meshed anew."""
        return self._file is not None

    @property
    def mesh_density(self) -> float:
        """Number of shell elements relative to the choice of the vehicle's file."""
        return self._mesh_density

    @property
    def title(self) -> str:
        """What titles call it, without its mass: by its file, as ``"Cargo truck"``, or by its name."""
        if self._file is None or self.name != self._file.name:
            return title_of_name(self.name)
        return without_mass(self._file.title)

    @property
    def kind(self) -> str | None:
        """What standards of testing call it, as ``"pickup"``; ``None`` where its file does not say."""
        return None if self._file is None else self._file.kind

    @property
    def points(self) -> Mapping[str, tuple[float, float, float]]:
        """Named points in the axes of the vehicle's file [m]: those of its file, and ``mass_center``."""
        x, y, z = self.center_of_mass.tolist()
        named = () if self._file is None else self._file.points
        return FrozenMapping({"mass_center": (x, y, z), **{point.name: point.at_m for point in named}})

    @property
    def scatter(self) -> Mapping[str, ClassScatter]:
        """How vehicles of its class differ from it, by the quantity; empty where its file does not say."""
        if self._file is None:
            return FrozenMapping({})
        known = {one.name for one in self._file.assumptions} - {one.name for one in self.assumptions}
        rows = (row for row in self._file.scatter if row.name not in known)
        return FrozenMapping({row.name: ClassScatter(row.median, row.log_sd, row.zones) for row in rows})

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """What was assumed of a vehicle made :meth:`from known facts <birm3d.Vehicle.from_facts>`.

        What was given to it since is assumed no more: sizes by ``scaled_to``, ``with_mass_center_height``,
        ``with_inertia``. One inertia that is given settles all three: the others follow from it.
        """
        told = () if self._file is None else self._file.assumptions
        known = {
            "mass_center_height": self._height is not None,
            **dict.fromkeys(INERTIAS, self._spread is not None),
        }
        return tuple(one for one in told if not known.get(one.name, False))

    @property
    def _strong_height(self) -> float | None:
        """See :mod:`birm3d.vehicle.front_height`; ``None`` of a vehicle made from arrays."""
        return None if self._shape is None else self._shape.strong_height(self.zones)

    @property
    def is_skin(self) -> npt.NDArray[np.bool_]:
        """Which nodes are tied to the rigid body by their first truss, shape (n,)."""
        return (self.wheel_of_node < 0) & (self.along_of_node < 0)

    @property
    def truss_law(self) -> Mapping[str, float]:
        """Law of a vehicle made from arrays: sums over its trusses [N/m, N], and its mean knee [m]."""
        if self._truss_laws is None:
            raise ValueError(f"truss law needs a vehicle made from arrays, got {self.name!r} with zones")
        return FrozenMapping(sums_of(self._truss_laws))

    @property
    def n_nodes(self) -> int:
        """Number of nodes of the shell and of the treads."""
        return len(self.nodes)

    @property
    def n_trusses(self) -> int:
        """Number of trusses: one for each node."""
        return len(self.nodes)

    @property
    def n_elements(self) -> int:
        """Number of four-node shell elements."""
        return len(self.quads)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, VehicleFields):
            return NotImplemented
        # The mesh follows from file and density.
        names = (field.name for field in dataclasses.fields(VehicleFields) if field.compare)
        return all(self._same(other, name) for name in names)

    def _same(self, other: VehicleFields, name: str) -> bool:
        mine, theirs = getattr(self, name), getattr(other, name)
        if isinstance(mine, np.ndarray) or isinstance(theirs, np.ndarray):
            return np.array_equal(mine, theirs)
        return bool(mine == theirs)

    __hash__ = None  # type: ignore[assignment]

    def _arguments(self) -> dict[str, Any]:
        stored = (field.name for field in dataclasses.fields(self) if field.metadata.get("stored", True))
        arguments = {name: getattr(self, name) for name in stored}
        return {**arguments, "zones": dict(self.zones)}

    def __reduce__(self) -> tuple[Any, ...]:
        return (
            _rebuild,
            (
                type(self),
                {**self._arguments(), "_shape": self._shape},
            ),
        )

    def __repr__(self) -> str:
        return (
            f"Vehicle({self.name!r}, mass={self.mass:.6g} kg, {self.n_nodes} nodes, "
            f"{len(self.wheels)} wheels, zones: {', '.join(self.zones) or 'none'})"
        )


def _rebuild(kind: type[VehicleFields], arguments: dict[str, Any]) -> VehicleFields:
    return kind(**arguments)
