"""Vehicles: a rigid body, its crushable skin and its wheels."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.arguments import checked
from ..base.checks import array
from ..base.frozen_mapping import FrozenMapping
from ..unit_check import Usual, given, warn_if_unusual
from ..units import Quantity, Stated, si
from .dimensions import Dimensions, dimensions
from .mass_center import stretched_inertia
from .payload import check_load, core_ranges, solids_at, structure_mass
from .scaling import SIZES, factors_of, scaling_between, sizes_given
from .vehicle_guard import as_built, changed_by_hand, check_parts
from .zone import KNEE, OPTIONAL, TRUSS_LAW, Zone, positive

if TYPE_CHECKING:
    from .articulated import ArticulatedVehicle, Joint
    from .vehicle_file import VehicleFile
    from .vehicle_shape import VehicleShape

__all__ = ["TRUSS_LAW", "Vehicle", "Zone"]

Floats = npt.NDArray[np.float64]
FloatsLike = npt.ArrayLike

NOT_STORED: Mapping[str, Any] = {"stored": False}
"""Metadata of a field that no file holds."""

# A mass beyond these shares of that of the file is most likely in another unit.
_LEAST, _MOST = 0.05, 10.0
_LAW_QUANTITIES = {
    "k_initial": "pressure per length",
    "knee": "length",
    "k_hardening": "pressure per length",
    "f_max": "pressure",
    "k_unloading": "pressure per length",
    "elastic_recovery": "length",
    "tail_depth": "length",
    "tail_slope": "pressure per length",
}


@checked
@dataclass(frozen=True, eq=False)
class Vehicle:
    """A vehicle; immutable. Make one with :meth:`preset`, :meth:`from_file` or :meth:`from_arrays`.

    Arrays are read-only, float64, SI, body axes r, s, t (forward, left, up) with the origin at the mass
    centre unless stated.

    Attributes
    ----------
    name : str
    mass : float
        [kg].
    center_of_mass : ndarray, shape (3,)
        In the axes of the vehicle's file (x forward, y left, z up, origin on the ground below the front
        axle) [m]; of a vehicle made from arrays: (0, 0, height above the ground).
    inertia : ndarray, shape (3, 3)
        About the mass centre [kg m^2].
    nodes, anchors : ndarray, shape (n, 3)
        Uncrushed nodes of the shell, then those of second trusses (:mod:`birm3d.vehicle.along_panel`), then
        of the treads by which tyres meet barriers (:mod:`birm3d.vehicle.tire_nodes`), and the points that
        their trusses start from [m]; the first of these, of the shell, are points of the rigid body.
    area : ndarray, shape (n,)
        Tributary area of each node [m^2]; 1 for vehicles made from arrays.
    wheel_of_node : ndarray of int, shape (n,)
        Index of the wheel whose tread the node is on; -1 for nodes of the shell.
    along_of_node : ndarray of int, shape (n,)
        Number of the node whose second truss, along the vehicle, this node carries; -1 for all others.
    zone_of_node : ndarray of int, shape (n,)
        Index into ``zones``; -1 for vehicles made from arrays.
    quads : ndarray of int, shape (m, 4)
        Shell elements; empty for vehicles made from arrays.
    wheels : ndarray, shape (w, 4)
        Centres and radius [m].
    mass_center_height : float
        Above the ground at rest [m].
    zones : mapping of str to Zone
    rate_sensitivity : float
        Optional physics, see :meth:`with_rate_sensitivity` [s/m].
    dent_reach : float
        Optional physics, see :meth:`with_dent_reach`.
    """

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
    dent_reach: float = 0.0
    wheel_of_node: npt.NDArray[np.int64] = dataclasses.field(default_factory=lambda: np.empty(0, np.int64))
    along_of_node: npt.NDArray[np.int64] = dataclasses.field(default_factory=lambda: np.empty(0, np.int64))
    # What made the vehicle: laws per truss (m, N, N/m), or a file with its mesh density.
    _truss_laws: Floats | None = None
    _file: VehicleFile | None = None
    _shape: VehicleShape | None = dataclasses.field(default=None, compare=False, metadata=NOT_STORED)
    _mesh_density: float = 1.0
    _height: float | None = None  # of the mass centre, where one was asked for, in place of the solids' [m]
    _draft: bool = False  # between two changes: the core is not built yet, see draft()
    _load_density: float | None = None  # of the goods in the load space, where not the file's [kg/m^3]
    # Fields as they were made, which tell what dataclasses.replace() was given; and the names of those.
    _built: Mapping[str, Any] | None = dataclasses.field(default=None, compare=False, metadata=NOT_STORED)
    _own: tuple[str, ...] = dataclasses.field(default=(), compare=False)

    def __post_init__(self) -> None:
        for name in ("wheel_of_node", "along_of_node"):
            if len(getattr(self, name)) == 0:
                object.__setattr__(self, name, np.full(len(self.nodes), -1, np.int64))
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
        object.__setattr__(self, "zones", FrozenMapping(dict(self.zones)))
        if self._built is not None:
            changed = changed_by_hand(self, self._built)
            object.__setattr__(self, "_own", tuple(dict.fromkeys((*self._own, *changed))))
        object.__setattr__(self, "_built", as_built(self))
        check_parts(self)
        if self._file is not None and self._shape is None:  # a file of a result has the arrays only
            object.__setattr__(self, "_shape", self._shape_of_file(self._file))
        if not self._draft:
            _ = self.core  # the core checks every number

    # ---- making vehicles ----------------------------------------------------------------------------------

    @staticmethod
    def presets() -> tuple[str, ...]:
        """Names of the vehicles that come with the package."""
        from .vehicle_file import preset_names

        return preset_names()

    @staticmethod
    def preset(name: str, *, gvw: Quantity | None = None, mesh_density: float = 1.0) -> Vehicle:
        """Return a vehicle that comes with the package.

        Parameters
        ----------
        name
            One of :meth:`presets`.
        gvw
            Gross vehicle weight as a mass [kg], or text as ``"4500 lb"``; ``None``: the file's.
        mesh_density
            Number of shell elements relative to the file's choice (about 6,000).
        """
        from .vehicle_file import preset_path

        return _read(preset_path(name), gvw, mesh_density)

    @staticmethod
    def from_file(path: str | Path, *, gvw: Quantity | None = None, mesh_density: float = 1.0) -> Vehicle:
        """Read a vehicle file (TOML), of one unit or of two; the presets are files of the same format.

        Raises
        ------
        FileFormatError
            Naming file, line, key, limit and value of everything that is wrong in the file.
        ValueError
            If the vehicle can not have that weight or mesh.
        UnitWarning
            As a warning, if ``gvw`` is most likely in another unit, as 7.5 for 7.5 t.
        """
        from ..io.file_format import reading
        from .vehicle_file import VehicleFileError

        try:
            return _read(path, gvw, mesh_density)
        except VehicleFileError:
            raise
        except (ValueError, TypeError, ArithmeticError, LookupError, AttributeError):
            # Is it the file or the arguments? Without them a good file gives a vehicle.
            with reading(path, "must be a vehicle", VehicleFileError):
                _read(path, None, 1.0)
            raise

    def save(self, path: str | Path) -> None:
        """Write the vehicle to a file (TOML) that :meth:`from_file` reads back as the same vehicle.

        The file has all blocks of the one that the vehicle comes from, with their sources, and a block
        ``[changes]`` with what the methods ``with_...`` have changed since: mass, payload, zones, height of
        the mass centre, mesh density, rate sensitivity, dents, tyres.

        Parameters
        ----------
        path
            File to write, in a folder that exists; replaced only when all of it is written.

        Raises
        ------
        ValueError
            If the vehicle was made from arrays, or has been changed in what a file can not hold.
        """
        from .vehicle_writer import save_vehicle

        save_vehicle(self, path)

    def export_core(self, path: str | Path) -> None:
        """Write the prepared vehicle to a file that the C++ library reads without Python.

        The file holds mesh, laws and mass properties, not what made them: :meth:`from_file` does not read it.
        It is text of version 1, which ``birm3d/model/vehicle_text.hpp`` describes. Its numbers are exact, so
        that a run in C++ gives the same bits.

        Parameters
        ----------
        path
            File to write, in a folder that exists; replaced only when all of it is written.

        Raises
        ------
        ValueError
            If ``path`` is a folder or lies in none.
        """
        from .core_file import export_core

        export_core(self, path)

    @staticmethod
    def from_arrays(
        *,
        mass: Quantity,
        inertia: FloatsLike,
        nodes: FloatsLike,
        anchors: FloatsLike,
        k_initial: FloatsLike,
        k_unloading: FloatsLike,
        knee: FloatsLike = math.inf,
        k_hardening: FloatsLike = 0.0,
        f_max: FloatsLike = math.inf,
        mass_center_height: Quantity = 0.0,
        wheels: Sequence[Sequence[float]] = (),
        name: str = "from_arrays",
    ) -> Vehicle:
        """Make a vehicle for laboratories, tests and importers, truss by truss.

        Parameters
        ----------
        mass
            [kg].
        inertia
            Shape (3, 3), about the mass centre, body axes [kg m^2].
        nodes, anchors
            Shape (n, 3), body axes, origin at the mass centre [m].
        k_initial, knee, k_hardening, f_max, k_unloading
            Law of each truss (Fig. 3), shape (n,) or scalars: N/m, m, N/m, N, N/m. ``knee`` and ``f_max``
            may be infinite.
        mass_center_height
            Above the ground at rest [m].
        wheels
            Shape (w, 4): centre in body axes and radius [m].
        """
        height = si("mass_center_height", mass_center_height, "length")
        node = array("nodes", nodes, "n", 3).copy()
        n = len(node)
        laws = np.empty((n, 5))
        columns = {
            "k_initial": k_initial,
            "knee": knee,
            "k_hardening": k_hardening,
            "f_max": f_max,
            "k_unloading": k_unloading,
        }
        for i, (label, value) in enumerate(columns.items()):
            column = np.asarray(value, float)
            if column.shape not in ((), (n,)):
                raise ValueError(f"{label} must have shape () or ({n},), got {column.shape}")
            laws[:, i] = column
        discs = np.empty((0, 4)) if len(wheels) == 0 else array("wheels", wheels, "w", 4).copy()
        return Vehicle(
            name=name,
            mass=si("mass", mass, "mass"),
            center_of_mass=np.array([0.0, 0.0, height]),
            inertia=array("inertia", inertia, 3, 3).copy(),
            nodes=node,
            anchors=array("anchors", anchors, "n", 3).copy(),
            area=np.ones(n),
            zone_of_node=np.full(n, -1, np.int64),
            quads=np.empty((0, 4), np.int64),
            wheels=discs,
            mass_center_height=height,
            zones={},
            _truss_laws=laws,
        )

    @staticmethod
    def articulated(units: Sequence[Vehicle], joint: Joint, *, name: str | None = None) -> ArticulatedVehicle:
        """Make one vehicle of a leading and a trailing unit, as a tractor and its semi-trailer.

        Parameters
        ----------
        units
            Two vehicles of one unit, from files or arrays; the leading one first.
        joint
            See :class:`birm3d.Joint`.
        name
            ``None``: the names of both.

        Raises
        ------
        ValueError
            If there are not two units of one body, if a zone's name is in both, or if the heights of the
            joint on the two units differ by more than 1 mm.
        """
        from .articulated import articulate

        return articulate(units, joint, name)

    def with_gvw(self, gvw: Quantity) -> Vehicle:
        """Return the vehicle with another mass [kg]; every mass property follows.

        Payload is rescaled first: goods in a load space keep their density and stand higher, see
        :meth:`with_payload`; below the unladen mass the structure is rescaled, without payload.
        A height given by :meth:`with_mass_center_height` stays. A vehicle made from arrays keeps its mass
        centre and scales its inertia.

        Raises
        ------
        ValueError
            If the mass is not > 0, or a change by ``dataclasses.replace()`` would be lost.
        UnitWarning
            As a warning, if the mass is most likely in another unit.
        """
        return self._with_mass(self._mass_given("gvw", gvw))

    def _with_mass(self, gvw: float) -> Vehicle:
        if self._file is None:
            return dataclasses.replace(
                self,
                mass=gvw,
                inertia=self.inertia * (gvw / self.mass),
                wheels=self.wheels.copy(),
                _built=None,
            )
        return self._assembled(gvw, self._height)

    def _assembled(self, mass: float, height: float | None) -> Vehicle:
        """Return the vehicle of the same file and mesh with another mass and height of the mass centre."""
        assert self._file is not None
        assert self._shape is not None
        return self._anew(
            _assemble(
                self._file,
                self._shape,
                mass,
                self._mesh_density,
                self.zones,
                height,
                self._draft,
                self._load_density,
            )
        )

    def _shape_of_file(self, file: VehicleFile) -> VehicleShape:
        """Return what all vehicles of the file and mesh density share."""
        from .vehicle_shape import shape_of

        shape = shape_of(file, self._mesh_density)
        return shape if (self.wheel_of_node >= 0).any() else shape.without_treads

    def _mass_given(self, name: str, mass: Quantity) -> float:
        """Return a mass [kg] > 0, with a word if it is far from that of the vehicle's file."""
        number = positive(name, si(name, mass, "mass"))
        if not isinstance(mass, (str, Stated)) and not self._draft and self.has_file:
            usual = sum(unit._file.gvw_kg for unit in self.units if unit._file is not None)
            warn_if_unusual(name, number, Usual(usual * _LEAST, usual * _MOST, "kg", "t"))
        return number

    def with_payload(
        self, payload: Quantity, *, density: Quantity | None = None, height: Quantity | None = None
    ) -> Vehicle:
        """Return the vehicle with its structure as it is and another payload [kg], 0 for none.

        Goods in a load space (of a cargo truck) cover its floor and stand as high as mass and density say, so
        that the mass centre rises as the load grows; in a full space they are packed denser. Other payload,
        as people on seats, gets heavier where it is.

        Parameters
        ----------
        payload
            All of it [kg], >= 0.
        density, height
            Of the goods [kg/m^3], or of their top above the floor [m], at most that of the space. Neither:
            the density stays. A later :meth:`with_gvw` keeps the density. Where
            :meth:`with_mass_center_height` has given the height of the mass centre, that one stays.

        Raises
        ------
        ValueError
            If the vehicle has no payload, or no load space for a density or a height, or if the goods do not
            fit.
        """
        payload = given("payload", payload)
        density = None if density is None else si("density", density, "density")
        height = None if height is None else si("height", height, "length")
        if not (math.isfinite(payload) and payload >= 0.0):
            raise ValueError(f"payload must be finite and >= 0, got {payload}")
        if self._file is None or (structure := structure_mass(self._file)) == 0.0:
            raise ValueError(f"payload needs a vehicle whose file names one, got {self.name!r}")
        changed = check_load(self._file, payload, density, height)
        loaded = self if changed is None else dataclasses.replace(self, _load_density=changed)
        return loaded._with_mass(structure + payload)

    def scaled_to(
        self,
        mass: Quantity,
        *,
        length: Quantity | None = None,
        width: Quantity | None = None,
        height: Quantity | None = None,
        wheelbase: Quantity | None = None,
        mass_center_height: Quantity | None = None,
    ) -> Vehicle:
        """Return another vehicle of the same class: this one as its file loads it, of another mass and size.

        All solids get heavier in proportion, and so do all forces of the zones: at the same size the same
        crash is met with the same deceleration and the same crush. So predicted, the crush of 37 vehicles
        that no zone was fitted to has a median error of 7 % (``tests/bench/bench_blind.py``). For a load in
        this vehicle see :meth:`with_gvw` and :meth:`with_payload`, which leave the zones alone.

        Shape, solids, wheels, core, zones and named points go to the new size together, so that the inertia
        follows: every radius of gyration goes with the dimensions across it. What is crushed is stretched
        with the structure, and forces follow from mass over depth: :mod:`birm3d.vehicle.scaling`.

        Parameters
        ----------
        mass
            [kg]; the zones hold at the mass that the file says, as a rule that of a tested vehicle.
        length, width, height
            [m], overall; ``None``: stays. A quarter to four times the present one.
        wheelbase
            From the first to the last axle [m]; ``None``: in proportion to the length. What lies between the
            axles goes with it, overhangs with what is left of the length; the first axle stays in place.
        mass_center_height
            Above the ground [m], as :meth:`with_mass_center_height` has it; ``None``: in proportion to the
            height.

        Raises
        ------
        ValueError
            If a number is out of range, the vehicle has no file, or a change by ``dataclasses.replace()``
            would be lost.
        """
        mass = self._mass_given("mass", mass)
        if self._file is None:
            raise ValueError(f"scaled_to needs a vehicle that has a file, got {self.name!r} from arrays")
        file = self._file
        wanted = sizes_given(length=length, width=width, height=height, wheelbase=wheelbase)
        scaling = scaling_between(file.extent, factors_of(wanted, self._sizes, self.name))
        factors = file.law_factors(mass, scaling)
        zones = {name: zone.scaled(*factors[name]) for name, zone in self.zones.items()}
        up = scaling.z.stretch(0.0, file.extent.top)
        density = self._load_density
        if density is not None:
            density *= mass / file.gvw_kg / scaling.volume(file.extent)
        scaled = _from_file(
            file.scaled_to(mass, scaling),
            mass,
            self._mesh_density,
            zones,
            None if self._height is None else up * self._height,
            self._draft,
            density,
        )
        reach = scaling.reach(file.extent) * self.dent_reach
        vehicle = dataclasses.replace(self._anew(scaled), dent_reach=reach)
        return vehicle if mass_center_height is None else vehicle.with_mass_center_height(mass_center_height)

    def with_rate_sensitivity(self, rate_sensitivity: Quantity) -> Vehicle:
        """Return the vehicle with loading envelopes that grow with speed; at 0 that is left out.

        What is crushed has inertia and rate strength, which the paper's massless trusses lack: an envelope
        grows by 1 + (rate_sensitivity * rate of deflection)^2 while it is loaded [s/m], >= 0. Finite-element
        vehicles were met with 0.05 to 0.07 s/m (``tests/bench/README.md``).
        """
        return dataclasses.replace(
            self, rate_sensitivity=si("rate_sensitivity", rate_sensitivity, "time per length")
        )

    def with_dent_reach(self, dent_reach: Quantity) -> Vehicle:
        """Return the vehicle with a skin that a post draws in beside itself; at 0 that is left out.

        A post (bollard, pole) that has come a depth d into a front, side or rear draws in the skin to either
        side of it and above it with a slope of about d / dent_reach, at a touch 0.25: its dent reaches about
        dent_reach [m] beyond it, as far as the beams and panels there carry. The paper's trusses know nothing
        of each other, and between them a narrow post passes to the rigid core. Walls and meshes make no dent.
        ``>= 0``.
        """
        reach = si("dent_reach", dent_reach, "length") if self._draft else given("dent_reach", dent_reach)
        return dataclasses.replace(self, dent_reach=reach)

    def without_tire_contact(self) -> Vehicle:
        """Return the vehicle with tyres that meet the ground only; see :mod:`birm3d.vehicle.tire_nodes`."""
        shell = self.wheel_of_node < 0
        if shell.all():
            return self
        columns = ("nodes", "anchors", "area", "zone_of_node", "wheel_of_node", "along_of_node")
        changes = {name: getattr(self, name)[shell] for name in columns}
        if self._shape is not None:
            shape = self._shape.without_treads
            for name in columns[2:]:
                if getattr(self, name) is getattr(self._shape, name):
                    changes[name] = getattr(shape, name)
            changes["_shape"] = shape
        return dataclasses.replace(self, _built=None, **changes)

    def with_mesh_density(self, mesh_density: float) -> Vehicle:
        """Return the vehicle with another number of shell elements, relative to its file's choice."""
        if self._file is None:
            raise ValueError(f"mesh_density needs a vehicle that has a file, got {self.name!r} from arrays")
        return self._anew(
            _from_file(
                self._file,
                self.mass,
                mesh_density,
                self.zones,
                self._height,
                self._draft,
                self._load_density,
            )
        )

    def with_mass_center_height(self, height: Quantity | None) -> Vehicle:
        """Return the vehicle with its mass centre at another height above the ground [m].

        All parts of the mass go up or down in proportion to their height above the ground and keep their
        place in plan: of the solids z becomes z times the ratio of the heights. So the inertia about the mass
        centre follows (:mod:`birm3d.vehicle.mass_center`): vertical second moments grow with the square
        of the ratio, the yaw inertia stays. Skin, core and wheels stay where they are. The height holds for
        every later mass and payload, and for a vehicle of another mass (:meth:`scaled_to`).

        Parameters
        ----------
        height
            [m], > 0 and below the vehicle's top; ``None``: what the solids of its file give.

        Raises
        ------
        ValueError
            If the height is out of range, or the mass centre of a vehicle from arrays is on the ground, where
            no ratio leads away from.
        """
        if self._file is not None:
            if height is not None:
                height = positive("mass_center_height", si("mass_center_height", height, "length"))
                if not height < self.height:
                    raise ValueError(
                        f"mass_center_height must be below the vehicle's top, {self.height:.4g} m; "
                        f"got {height:g}"
                    )
            return self._assembled(self.mass, height)
        if height is None:
            raise ValueError(f"mass_center_height must be given: {self.name!r} has no file with solids")
        height = positive("mass_center_height", si("mass_center_height", height, "length"))
        if not self.mass_center_height > 0.0:
            raise ValueError(
                f"mass_center_height must be above the ground to be changed, got {self.name!r} with "
                f"{self.mass_center_height} m; from_arrays() takes another"
            )
        up = np.array([0.0, 0.0, height - self.mass_center_height])
        wheels = self.wheels.copy()
        wheels[:, :3] -= up
        return dataclasses.replace(
            self,
            center_of_mass=np.array([*self.center_of_mass[:2], height]),
            inertia=stretched_inertia(self.inertia, height / self.mass_center_height),
            nodes=self.nodes - up,
            anchors=self.anchors - up,
            wheels=wheels,
            mass_center_height=height,
            _height=height,
            _built=None,
        )

    def with_zone(self, name: str, **changes: Any) -> Vehicle:
        """Return the vehicle with other stiffness numbers in one zone (see :class:`Zone`).

        Text with a unit is taken too, as ``knee="20 cm"`` or ``f_max="1.1 MPa"`` (``k_initial`` in MPa/m).
        A zone with an envelope becomes one with a knee when ``k_initial``, ``knee`` and ``k_hardening`` are
        given, and the other way round when ``envelope`` is. Such a law is a new one, and so is one of which
        all of Fig. 3 but ``f_max`` is given: ``elastic_recovery`` and the tail of the old one do not go on,
        unless they are given too.
        """
        if name not in self.zones:
            known = ", ".join(self.zones) or "none: the vehicle was made from arrays"
            raise ValueError(f"zone must be one of {known}; got {name!r}")
        known = ", ".join((*KNEE, "k_unloading", "envelope", *OPTIONAL))
        for key in changes:
            if key not in known.split(", "):
                raise ValueError(f"zone parameter must be one of {known}; got {key!r}")
        if "envelope" in changes:
            changes = {**dict.fromkeys((*KNEE, *OPTIONAL)), **changes}
        elif self.zones[name].envelope is not None and any(key in changes for key in KNEE):
            missing = [key for key in KNEE[:3] if key not in changes]
            if missing:
                raise ValueError(
                    f"{missing[0]} must be given too: zone {name!r} has an envelope, "
                    f"which needs {', '.join(KNEE[:3])} to take its place; got {', '.join(changes)}"
                )
            changes = {"envelope": None, **dict.fromkeys(OPTIONAL), **changes}
        elif {*KNEE[:3], "k_unloading"} <= changes.keys():
            changes = {**dict.fromkeys(OPTIONAL), **changes}
        for key, quantity in _LAW_QUANTITIES.items():
            if isinstance(changes.get(key), str):
                changes[key] = si(key, changes[key], quantity)
        return self.with_zones({name: dataclasses.replace(self.zones[name], **changes)})

    def with_zones(self, zones: Mapping[str, Zone]) -> Vehicle:
        """Return the vehicle with some of its zones replaced."""
        for name in zones:
            if name not in self.zones:
                raise ValueError(f"zone must be one of {', '.join(self.zones) or 'none'}; got {name!r}")
            if zones[name] != self.zones[name] and name not in self.zones_met:
                raise ValueError(
                    f"zone must be one that trusses belong to ({', '.join(self.zones_met)}), or its change "
                    f"has no effect; got {name!r}"
                )
        return dataclasses.replace(self, zones={**self.zones, **zones})

    def with_truss_law(self, **changes: float) -> Vehicle:
        """Return a vehicle made from arrays with another law, given for all trusses together.

        Stiffnesses and forces [N/m, N] are sums over the trusses and are shared as the present ones are; a
        knee [m] goes to every truss.
        """
        now = self.truss_law
        for name in changes:
            if name not in now:
                raise ValueError(f"truss law must be one of {', '.join(now)}; got {name!r}")
        assert self._truss_laws is not None  # else truss_law has raised
        laws = self._truss_laws.copy()
        for name, value in changes.items():
            column = laws[:, TRUSS_LAW.index(name)]
            if name == "knee" or not (math.isfinite(now[name]) and now[name] > 0.0):
                column[:] = value if name == "knee" else value / len(column)
            else:
                column *= value / now[name]
        return dataclasses.replace(self, _truss_laws=laws)

    def _anew(self, vehicle: Vehicle) -> Vehicle:
        """Return a vehicle made anew from the file with what the file does not hold."""
        if self._own:
            raise ValueError(
                f"{', '.join(self._own)} of {self.name!r} must be changed after what is made from its file, "
                "or the change is lost: call with_gvw, with_payload, scaled_to, with_mesh_density and "
                "with_mass_center_height first, dataclasses.replace() last"
            )
        if not (self.wheel_of_node >= 0).any():
            vehicle = vehicle.without_tire_contact()
        names = ("name", "rate_sensitivity", "dent_reach")
        others = {n: getattr(self, n) for n in names if getattr(self, n) != getattr(vehicle, n)}
        return dataclasses.replace(vehicle, **others) if others else vehicle

    def draft(self) -> Vehicle:
        """Return the vehicle to be changed several times at the cost of one; end with :meth:`finished`.

        Of a draft the numbers are not checked and nothing can be run.
        """
        return dataclasses.replace(self, _draft=True)

    def finished(self) -> Vehicle:
        """Return a draft as a vehicle, checked."""
        return dataclasses.replace(self, _draft=False)

    # ---- what it is ---------------------------------------------------------------------------------------

    @property
    def units(self) -> tuple[Vehicle, ...]:
        """The rigid bodies, each as a vehicle of its own; (self,) where there is one."""
        return (self,)

    @property
    def joint(self) -> Joint | None:
        """What joins the units; ``None`` where there is one."""
        return None

    @property
    def has_file(self) -> bool:
        """Whether the vehicle comes from a file, so that it can be meshed anew."""
        return self._file is not None

    @property
    def mesh_density(self) -> float:
        """Number of shell elements relative to the choice of the vehicle's file."""
        return self._mesh_density

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
    def is_skin(self) -> npt.NDArray[np.bool_]:
        """Which nodes are tied to the rigid body by their first truss, shape (n,)."""
        return (self.wheel_of_node < 0) & (self.along_of_node < 0)

    @property
    def truss_law(self) -> Mapping[str, float]:
        """Law of a vehicle made from arrays: sums over its trusses [N/m, N], and its mean knee [m]."""
        if self._truss_laws is None:
            raise ValueError(f"truss law needs a vehicle made from arrays, got {self.name!r} with zones")
        total = self._truss_laws.sum(axis=0)
        total[TRUSS_LAW.index("knee")] /= len(self._truss_laws)
        return FrozenMapping(dict(zip(TRUSS_LAW, total.tolist(), strict=True)))

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

    @cached_property
    def _dimensions(self) -> Dimensions:
        found = dimensions(self.nodes, self.wheels, self.mass_center_height)
        if self._file is None or not self._is_shape():
            return found
        extent = self._file.extent  # exact; a mesh falls short by hundredths of 1 %
        return found._replace(length=extent.length, width=extent.width, height=extent.top)

    @property
    def _sizes(self) -> dict[str, float | None]:
        return {name: getattr(self, name) for name in SIZES}

    @property
    def length(self) -> float:
        """Overall length of the uncrushed vehicle, wheels included [m]: of its file, or of its nodes."""
        return self._dimensions.length

    @property
    def width(self) -> float:
        """Overall width, tyres included, mirrors not [m]."""
        return self._dimensions.width

    @property
    def height(self) -> float:
        """Of its highest point above the ground, at rest [m]."""
        return self._dimensions.height

    @property
    def wheelbase(self) -> float | None:
        """From the first axle to the last one [m]; ``None`` where there are not two."""
        return self._dimensions.wheelbase

    @property
    def track(self) -> float | None:
        """Between the middles of the first axle's outermost wheels [m]; ``None`` where it has not two."""
        return self._dimensions.track

    @cached_property
    def zones_met(self) -> tuple[str, ...]:
        """Names of the zones that hold trusses; a zone without any, as of tyres left out, has no effect."""
        count = np.bincount(self.zone_of_node[self.zone_of_node >= 0], minlength=len(self.zones))
        return tuple(name for name, n in zip(self.zones, count, strict=True) if n > 0)

    @cached_property
    def skin_bounds(self) -> tuple[Floats, Floats]:
        """Lowest and highest coordinates of the skin's nodes, body axes, shape (3,) each [m]."""
        skin = self.nodes[self.is_skin]
        return skin.min(axis=0), skin.max(axis=0)

    @cached_property
    def node_spacing(self) -> float:
        """Distance between neighbours of the skin [m]: the median, see :mod:`birm3d.vehicle.node_spacing`."""
        from .node_spacing import node_spacing

        if self._shape is not None and self._is_shape():
            return self._shape.node_spacing
        return node_spacing(self.nodes[self.is_skin])

    @cached_property
    def core(self) -> _core.Vehicle:
        """The same vehicle for the core."""
        return _core.Vehicle([self._core_unit(np.zeros(3))], [])

    def _core_unit(self, offset: Floats) -> _core.Unit:
        """Return the rigid body for the core; offset of its mass centre along the ground (3,) [m]."""
        if self._shape is not None and self._is_shape():
            trusses = self._shape.trusses(self.zones, self.rate_sensitivity, self.dent_reach)
            origin = self.center_of_mass
        else:
            trusses, origin = _core.TrussMesh(**self._truss_arguments()), np.zeros(3)
        return _core.Unit(**self._unit_arguments(offset), trusses=trusses, origin=origin)

    def _core_arguments(self) -> list[dict[str, Any]]:
        """Return what the core is made of, unit by unit: arguments of its Unit and of its TrussMesh."""
        return [self._arguments_of_unit(np.zeros(3))]

    def _arguments_of_unit(self, offset: Floats) -> dict[str, Any]:
        arguments = self._unit_arguments(offset)
        if self._shape is not None and self._is_shape():
            laws = (self.zones, self.rate_sensitivity, self.dent_reach)
            trusses, origin = self._shape.truss_arguments(*laws), self.center_of_mass
        else:
            trusses, origin = self._truss_arguments(), np.zeros(3)
        return {**arguments, "trusses": trusses, "origin": origin}

    def _unit_arguments(self, offset: Floats) -> dict[str, Any]:
        return {
            "mass": self.mass,
            "inertia": self.inertia,
            "wheels": self.wheels,
            "mass_center_height": self.mass_center_height,
            "offset": offset,
            "core": self._core_boxes(),
        }

    def _truss_arguments(self) -> dict[str, Any]:
        """Return the trusses for the core, body axes."""
        if self._truss_laws is not None:
            laws, which = self._truss_laws[:1], np.zeros(self.n_nodes, int)
            if not (self._truss_laws == laws).all():  # sorting them takes longer than a short run
                laws, which = np.unique(self._truss_laws, axis=0, return_inverse=True)
            curves = [
                _core.knee_curve(k_initial=a, knee=d, k_hardening=b, f_max=f, k_unloading=u)
                for a, d, b, f, u in laws.tolist()
            ]
            curve_of = which.reshape(-1)
        else:
            curves = [zone.curve for zone in self.zones.values()]
            curve_of = self.zone_of_node
        return {
            "nodes": self.nodes,
            "anchors": self.anchors,
            "curves": curves,
            "curve_of": curve_of,
            "scale": self.area,
            "wheels": self.wheels,
            "rate_sensitivity": self.rate_sensitivity,
            "dent_reach": self.dent_reach,
            "wheel_of": self.wheel_of_node,
            "along_of": self.along_of_node,
        }

    def _is_shape(self) -> bool:
        """Whether the arrays are those of the shape, nodes and anchors seen from the mass centre."""
        shape = self._shape
        if shape is None:
            return False
        names = ("area", "zone_of_node", "wheel_of_node", "along_of_node")
        pairs = [(getattr(self, name), getattr(shape, name)) for name in names]
        pairs += zip((self.nodes, self.anchors), shape.seen_from(self.center_of_mass), strict=True)
        return all(own is seen or np.array_equal(own, seen) for own, seen in pairs)

    def _core_boxes(self) -> Floats:
        """Return middles and half edges of the rigid body's boxes, body axes, shape (k, 6) [m]."""
        if self._file is None:
            return np.empty((0, 6))
        low, high = core_ranges(self._file).transpose(2, 0, 1) - self.center_of_mass
        return np.hstack([0.5 * (low + high), 0.5 * (high - low)])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Vehicle):
            return NotImplemented
        # The mesh follows from file and density.
        names = (field.name for field in dataclasses.fields(Vehicle) if field.compare)
        return all(self._same(other, name) for name in names)

    def _same(self, other: Vehicle, name: str) -> bool:
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
        return (_rebuild, ({**self._arguments(), "_shape": self._shape},))

    def __repr__(self) -> str:
        return (
            f"Vehicle({self.name!r}, mass={self.mass:.6g} kg, {self.n_nodes} nodes, "
            f"{len(self.wheels)} wheels, zones: {', '.join(self.zones) or 'none'})"
        )


def _rebuild(arguments: dict[str, Any]) -> Vehicle:
    return Vehicle(**arguments)


def _read(path: str | Path, gvw: Quantity | None, mesh_density: float) -> Vehicle:
    from .combination_file import read_combination
    from .vehicle_changes import vehicle_of
    from .vehicle_file import read_vehicle_file

    mass = None if gvw is None else positive("gvw", si("gvw", gvw, "mass"))
    combination = read_combination(path)
    if combination is None:
        vehicle = vehicle_of(read_vehicle_file(path), mass, mesh_density)
    else:
        from .articulated import combine

        units = [vehicle_of(unit, None, mesh_density) for unit in combination.units]
        vehicle = combine(units, combination.file)
        vehicle = vehicle if mass is None else vehicle._with_mass(mass)
    if gvw is not None:
        vehicle._mass_given("gvw", gvw)
    return vehicle


def _from_file(
    file: VehicleFile,
    gvw: float | None,
    mesh_density: float,
    zones: Mapping[str, Zone] | None,
    height: float | None = None,
    draft: bool = False,
    load_density: float | None = None,
) -> Vehicle:
    from .vehicle_shape import shape_of

    mass = file.gvw_kg if gvw is None else positive("gvw", gvw)
    shape = shape_of(file, float(mesh_density))
    return _assemble(file, shape, mass, mesh_density, zones, height, draft, load_density)


def _assemble(
    file: VehicleFile,
    shape: VehicleShape,
    mass: float,
    mesh_density: float,
    zones: Mapping[str, Zone] | None,
    height: float | None,
    draft: bool,
    load_density: float | None,
) -> Vehicle:
    properties = _core.mass_properties(*solids_at(file, mass, load_density))
    center = np.array(properties.center_of_mass)
    inertia = np.array(properties.inertia)
    if height is not None:
        inertia = stretched_inertia(inertia, height / center[2])
        center[2] = height
    wheels = shape.wheels.copy()
    wheels[:, :3] -= center
    nodes, anchors = shape.seen_from(center)
    return Vehicle(
        name=file.name,
        mass=mass,  # the solids' up to rounding, which would grow with every change
        center_of_mass=center,
        inertia=inertia,
        nodes=nodes,
        anchors=anchors,
        area=shape.area,
        zone_of_node=shape.zone_of_node,
        wheel_of_node=shape.wheel_of_node,
        along_of_node=shape.along_of_node,
        quads=shape.quads,
        wheels=wheels,
        mass_center_height=float(center[2]),
        zones=zones if zones is not None else file.laws,
        dent_reach=0.0 if file.dents is None else file.dents.reach_m,
        _file=file,
        _shape=shape,
        _mesh_density=mesh_density,
        _height=height,
        _draft=draft,
        _load_density=load_density,
    )
