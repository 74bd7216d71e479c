"""Vehicles of one rigid body or of two: each has a crushable skin and wheels."""

# Longer than 300 lines: what users read of a vehicle and how one is made. Methods of a vehicle of one unit
# return vehicles of two, which are derived from it: both stand here, so that no modules import each other.
from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np
import numpy.typing as npt

from .. import _core, pictures
from ..base.arguments import checked
from ..base.checks import array
from ..units import Quantity, si
from .built_fields import fields_of, joined_fields
from .combination_recipe import CombinationRecipe
from .core_arguments import core_unit, own_settings, unit_arguments
from .given_mass import warn_of_mass
from .joint import Joint, JointKind
from .old_names import OldVehicleNames
from .read_recipe import read, read_preset
from .recipe import VehicleRecipe
from .sliding_bed import with_sliding_bed
from .wheel_arguments import load_on_joint
from .zone import TRUSS_LAW, Zone

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from typing_extensions import Self

__all__ = ["TRUSS_LAW", "ArticulatedVehicle", "Vehicle", "Zone", "articulate", "build"]

Floats = npt.NDArray[np.float64]
FloatsLike = npt.ArrayLike


@checked
class Vehicle(OldVehicleNames):
    """A vehicle; immutable. See :meth:`preset`, :meth:`from_file`, :meth:`from_facts`, :meth:`from_mesh`.

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
        Uncrushed nodes, and the points that their trusses start from [m]. First come those of the shell,
        whose anchors are points of the rigid body. Then those of second trusses
        (:mod:`birm3d.vehicle.second_trusses`), then of the treads by which tyres meet barriers
        (:mod:`birm3d.vehicle.tire_nodes`).
    area : ndarray, shape (n,)
        Tributary area of each node [m^2]; 1 for vehicles made from arrays.
    wheel_of_node : ndarray of int, shape (n,)
        Index of the wheel whose tread the node is on; -1 for nodes of the shell.
    along_of_node : ndarray of int, shape (n,)
        Number of the node whose second truss this node carries, along the vehicle or across it; -1 for
        all others.
    zone_of_node : ndarray of int, shape (n,)
        Index into ``zones``; -1 for vehicles made from arrays.
    quads : ndarray of int, shape (m, 4)
        Shell elements; empty for vehicles made from arrays.
    wheels : ndarray, shape (w, 4)
        Centres and radius [m].
    zone_of_wheel : ndarray of int, shape (w,)
        Index into ``zones`` of the law of each wheel's tread, springs and hangers; -1 without one.
    mass_center_height : float
        Above the ground at rest [m].
    zones : mapping of str to Zone
    rate_sensitivity : float
        Optional physics, see :meth:`with_rate_sensitivity` [s/m].
    indentation_length : float
        Optional physics, see :meth:`with_indentation_length`.
    """

    _of_text: ClassVar[str] = "Vehicle.preset({}) returns one"

    @property
    def units(self) -> tuple[Vehicle, ...]:
        """The rigid bodies, each as a vehicle of its own; (self,) where there is one."""
        return (self,)

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
        return _of_read(read_preset(name, gvw, mesh_density), gvw)

    @staticmethod
    def from_file(path: str | Path, *, gvw: Quantity | None = None, mesh_density: float = 1.0) -> Vehicle:
        """Read a vehicle file (TOML), of one unit or of two; the presets are files of the same format.

        Raises
        ------
        FileFormatError
            Naming file, line, key, limit and value of everything that is wrong in the file.
        ValueError
            If the vehicle can not have that weight or mesh.
        UnitWarning, MassWarning
            As warnings, if ``gvw`` is most likely in another unit, as 7.5 for 7.5 t, or if no vehicle of the
            class can have it. The mass in the file's block ``[changes]`` is checked in the same way.
        """
        from ..io.file_format import reading
        from .vehicle_file import VehicleFileError

        try:
            return _of_read(read(path, gvw, mesh_density), gvw)
        except VehicleFileError:
            raise
        except (ValueError, TypeError, ArithmeticError, LookupError, AttributeError):
            # Is it the file or the arguments? Without them a good file gives a vehicle.
            with reading(path, "must be a vehicle", VehicleFileError):
                _of_read(read(path, None, 1.0), None)
            raise

    @staticmethod
    def from_facts(
        kind: str,
        *,
        mass: Quantity,
        length: Quantity | None = None,
        width: Quantity | None = None,
        height: Quantity | None = None,
        wheelbase: Quantity | None = None,
        mass_center_height: Quantity | None = None,
        mesh_density: float = 1.0,
    ) -> Vehicle:
        """Make a vehicle of which few facts are known: a preset of its class, scaled to them.

        Taken is the preset of the kind whose mass is nearest (:meth:`scaled_to` says what goes with what).
        What is not known is assumed, with a band. Dimensions go with the mass as those of NHTSA's test
        vehicles; those of trucks and buses stay, as their mass is the load's. :attr:`assumptions` says so in
        words and numbers, and so do the report of a run and the vehicle's file. :func:`birm3d.predict` draws
        from the bands, and :meth:`assumed_distributions` has them for other studies.

        Parameters
        ----------
        kind
            ``"car"``, ``"minivan"``, ``"pickup"``, ``"van"``, ``"truck"``, ``"cab_over_truck"``, ``"bus"``.
        mass
            As it crashes, load included [kg].
        length, width, height, wheelbase
            [m]; ``None``: not known.
        mass_center_height
            Above the ground [m]; ``None``: not known.
        mesh_density
            As :meth:`preset` has it.

        Raises
        ------
        ValueError
            If the kind is not known, or a fact is out of range for it.
        """
        from .from_facts import recipe_of_facts

        sizes = {"length": length, "width": width, "height": height, "wheelbase": wheelbase}
        return build(recipe_of_facts(kind, mass, sizes, mass_center_height, mesh_density))

    @staticmethod
    def from_mesh(
        path: str | Path,
        *,
        mass: Quantity,
        kind: str | None = None,
        like: Vehicle | str | None = None,
        unit: str | None = None,
        forward: str = "+x",
        up: str = "+z",
        holes: str | None = None,
        parts: Sequence[int | str] | None = None,
        without_parts: Sequence[int | str] = (),
        clearance: Quantity = 0.0,
        element_size: Quantity | None = None,
        wheelbase: Quantity | None = None,
        front_overhang: Quantity | None = None,
        wheel_radius: Quantity | None = None,
        track: Quantity | None = None,
        mass_center_height: Quantity | None = None,
        center_of_mass: FloatsLike | None = None,
        inertia: FloatsLike | None = None,
        use_densities: bool = False,
        zones: Mapping[str, Mapping[str, Any]] | None = None,
        core: Mapping[str, Mapping[str, Any]] | None = None,
        name: str | None = None,
        mesh_density: float = 1.0,
    ) -> Vehicle:
        """Make a vehicle whose skin is a mesh: an LS-DYNA keyword file, STL, OBJ, PLY, glTF, VTK, ...

        A mesh says where the skin is. Stiffness, rigid core, distribution of mass and tyres are those of the
        vehicle's class. They are scaled to the mass and to the size of the mesh as :meth:`from_facts` does
        it. :attr:`assumptions` says what was assumed, ``plot()`` shows it, :meth:`save` writes all of it to
        one file. Needs the extra ``mesh``.

        Of a keyword file, shells and solids of all parts and of included files are read. A closed skin is
        laid around them; engine and seats do no harm. Parts whose titles say tyre or wheel give the wheels.
        The middle of the mesh is the vehicle's, its lowest point is on the ground.

        Parameters
        ----------
        path
            Known by its ending: ``.k``, ``.key``, ``.dyn``; ``.stl``, ``.obj``, ``.ply``, ``.off``, ``.glb``,
            ``.gltf``; ``.vtk``, ``.vtu``, ``.msh``, ``.inp``, ``.bdf``, ...
        mass
            As it crashes, load included [kg].
        kind, like
            One of both: the class as in :meth:`from_facts`, or a vehicle of one unit (or a preset's name).
        unit
            Of the mesh: ``"m"``, ``"mm"``, ``"cm"``, ``"in"`` or ``"ft"``.
        forward, up
            Axes of the mesh, as ``"-x"``.
        holes
            ``"refuse"``: the mesh has to be a closed skin. ``"close"``: holes are filled. ``"wrap"``: a
            closed skin is laid around all parts, without wheels and mirrors. ``None``: wrap for keyword
            files, refuse for others.
        parts, without_parts
            Parts of the mesh to take, or to leave out, by numbers or pieces of titles.
        clearance
            Of the mesh's lowest point above the ground [m]; 0 where wheels are part of it.
        element_size
            Distance of the skin's nodes [m]; ``None``: that of the class.
        wheelbase, front_overhang, wheel_radius, track
            [m]; ``None``: those of the tyres in the mesh, or of the class.
        mass_center_height
            Above the ground [m].
        center_of_mass
            Shape (3,) [m]: x forward from the first axle, so mostly negative; y left; z above the ground.
        inertia
            About the mass centre, shape (3,) or (3, 3) [kg m^2].
        use_densities
            Whether mass centre and inertia follow from the densities, thicknesses and added masses of a
            keyword file, scaled to `mass`. Else they are those of the class.
        zones, core
            Blocks ``[zone.<name>]`` and ``[[core]]`` of a vehicle file by their names: a new one, or what
            differs from that of the class.
        name
            ``None``: that of the file.
        mesh_density
            Number of elements relative to the mesh; above 1 each triangle is cut into 4, 9, ... ones.

        Raises
        ------
        FileFormatError
            If the mesh is damaged, has holes or no volume, or its size is that of another unit.
        ValueError
            If another argument is out of range.
        ImportError
            If a library that reads the mesh is missing; says what to install.
        """
        from .mesh_import.facts import MeshFacts
        from .mesh_import.recipe_of_mesh import recipe_of_mesh

        others = {
            "kind": kind, "unit": unit, "forward": forward, "up": up, "holes": holes, "parts": parts,
            "without_parts": without_parts, "clearance": clearance, "element_size": element_size,
            "wheelbase": wheelbase, "front_overhang": front_overhang, "wheel_radius": wheel_radius,
            "track": track, "mass_center_height": mass_center_height, "center_of_mass": center_of_mass,
            "inertia": inertia, "use_densities": use_densities, "zones": zones, "core": core, "name": name,
        }  # fmt: skip
        return build(recipe_of_mesh(MeshFacts.given(path, mass, like, others), mesh_density))

    def assumed_distributions(self) -> dict[str, Any]:
        """Return the distributions of what was assumed of the vehicle, for :func:`birm3d.monte_carlo`.

        Each is lognormal. Its median is the vehicle's number, and 80 % of it lie within the band that
        :attr:`assumptions` says. The pitch inertia follows from the yaw inertia, as both are mostly due to
        the mass along the vehicle. What is known is not among them. :func:`birm3d.predict` draws the same by
        itself, beside the forces of the class.

        Returns
        -------
        dict of str to frozen distribution of scipy.stats
            Parameter, as ``"vehicle.length"`` (see :mod:`birm3d.scene_parameters`) -> its distribution, SI;
            empty where nothing was assumed.
        """
        from .assumed import assumed_distributions

        return assumed_distributions(self)

    def plot(self) -> Figure:
        """Return a figure of what the vehicle is made of, from four sides.

        Skin coloured by zones, rigid core, wheels, mass centre, sizes, and what was assumed.
        """
        return pictures.plot_vehicle(self)

    def _repr_html_(self) -> str:
        """Return what notebooks show: name, kind, mass and sizes."""
        return pictures.vehicle_html(self)

    def save(self, path: str | Path) -> None:
        """Write the vehicle to a file (TOML) that :meth:`from_file` reads back as the same vehicle.

        The file has all blocks of the one that the vehicle comes from, with their sources. A block
        ``[changes]`` has what the methods ``with_...`` have changed since: mass, payload, zones, height of
        the mass centre, mesh density, rate sensitivity, indentations, tyres.

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

        save_vehicle(self, path, Vehicle.from_file)

    def export_core(self, path: str | Path) -> None:
        """Write the prepared vehicle to a file that the C++ library reads without Python.

        The file holds mesh, laws and mass properties, not what made them: :meth:`from_file` does not read it.
        It is text, which ``birm3d/model/vehicle_text.hpp`` describes. Its numbers are exact, so that a run in
        C++ gives the same bits.

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
            If there are not two units of one body, or a zone's name is in both. If the heights of the joint
            on the two units differ by more than 1 mm.
        """
        return articulate(units, joint, name)

    def with_sliding_bed(self, slide: Sequence[tuple[float, float]] | None = None) -> ArticulatedVehicle:
        """Return the truck as two units: chassis and load bed, which slides along the frame.

        The bed stays where it is until stopping it takes more than its fixings hold. Then it slides on, and
        a force that depends on the slip slows it down. A mass, laws or other numbers that were changed
        before are kept. The chassis is the leading unit, so that motions of the result are its own. A sensor
        of ``"load_bed_leading_edge"`` is on the bed. ``metrics["bed_slip"]`` is how far the bed slid.

        Parameters
        ----------
        slide
            Force that holds the bed [N] against its slip [m], as (slip, force) pairs; see
            :class:`birm3d.Joint`. ``None``: that of the vehicle's file, whatever the load is.

        Raises
        ------
        ValueError
            If the vehicle's file has no block ``bed``, or the vehicle has two units already.
        """
        recipe = self._description
        if not isinstance(recipe, VehicleRecipe):
            raise ValueError(f"vehicle must be of one unit, got {self.name!r} of two")
        self._require_as_built()
        combined = build(with_sliding_bed(recipe, slide))
        assert isinstance(combined, ArticulatedVehicle)  # made of two recipes
        return combined


@checked
@dataclass(frozen=True, eq=False, repr=False)
class ArticulatedVehicle(Vehicle):
    """A vehicle of two units; make one with :meth:`Vehicle.articulated`. Immutable.

    It has all that a :class:`Vehicle` has, of the whole in the position of rest. Mass, mass centre (in the
    leading unit's axes) and inertia about it are those of both units. So are nodes, anchors, quads, wheels
    and zones, the leading unit's first. ``units`` are the two, each with its own in its own axes; zones keep
    their names, which differ between the units.

    ``with_zone``, ``with_rate_sensitivity``, ``with_indentation_length``, ``with_mesh_density`` and
    ``without_tire_contact`` go to the units that they concern. ``with_gvw`` and ``with_payload`` load or
    lighten the trailing unit; the mass must exceed that of the leading one. ``with_mass_center_height``
    raises the mass of both by one ratio, and a later mass keeps the height of the whole. ``scaled_to``
    scales both in proportion, and the places of the joint with them, so that ``wheelbase`` must be ``None``.
    ``with_unit`` and ``with_joint`` change a part. ``dataclasses.replace()`` changes the name only.
    """

    _units: tuple[Vehicle, ...] = ()
    _joint: Joint | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self._own:
            raise ValueError(
                f"{', '.join(self._own)} of a vehicle of two units must be changed in its units, from which "
                f"all of it follows: by with_unit(), or another method of {self.name!r}"
            )

    @property
    def units(self) -> tuple[Vehicle, ...]:
        """The leading and the trailing unit, each a vehicle of its own."""
        return self._units

    @property
    def joint(self) -> Joint:
        """What joins the units."""
        assert self._joint is not None  # made together with the units
        return self._joint

    @cached_property
    def _description(self) -> CombinationRecipe:
        leading, trailing = (unit._description for unit in self._units)
        assert isinstance(leading, VehicleRecipe)  # units are of one body, see articulate
        assert isinstance(trailing, VehicleRecipe)
        return CombinationRecipe(self.name, leading, trailing, self.joint)

    def _changed(self, recipe: VehicleRecipe | CombinationRecipe) -> Self:
        if recipe is self._description:
            return self
        assert isinstance(recipe, CombinationRecipe)  # a change keeps the number of units
        units = [unit._changed(new) for unit, new in zip(self._units, recipe.units, strict=True)]
        return cast("Self", articulate(units, recipe.joint, recipe.name))

    @cached_property
    def core(self) -> _core.Vehicle:
        """The same vehicle for the core; its reference point is the leading unit's mass centre."""
        joint = self.joint
        leading, trailing = self._units
        core_joint = _core.Joint(
            kind=_core.JointKind.__members__[joint.kind],
            leading=0,
            trailing=1,
            place_on_leading=joint.place_on_leading - leading.center_of_mass,
            place_on_trailing=joint.place_on_trailing - trailing.center_of_mass,
            roll_limit=math.radians(joint.roll_limit),
            slide=np.reshape(joint.slide if joint.kind == "sliding" else (), (-1, 2)),
        )
        units = [core_unit(*unit) for unit in self._placed_units()]
        return _core.Vehicle(units, [core_joint], **self._own_settings())

    def _own_settings(self) -> dict[str, float]:
        return own_settings(self, self._units[0])

    def _placed_units(self) -> list[tuple[Vehicle, Floats, tuple[Floats, float]]]:
        """Return each unit, where its mass centre is, and what presses on it at the joint."""
        leading, trailing = self._units
        on_trailing = self.joint.place_on_trailing - trailing.center_of_mass
        load = load_on_joint(trailing, on_trailing)
        on_leading = self.joint.place_on_leading - leading.center_of_mass
        return [
            (leading, np.zeros(3), (on_leading, load)),
            (trailing, self._trailing_offset(), (on_trailing, -load)),
        ]

    def _trailing_offset(self) -> Floats:
        """Return the trailing mass centre along the ground, from the leading one, shape (3,) [m]."""
        leading, trailing = self._units
        offset = trailing.center_of_mass + self.joint.shift - leading.center_of_mass
        offset[2] = 0.0
        return offset

    def _core_arguments(self) -> list[dict[str, Any]]:
        return [unit_arguments(*unit) for unit in self._placed_units()]

    def with_unit(self, index: int, unit: Vehicle) -> ArticulatedVehicle:
        """Return the vehicle with another leading (0) or trailing (1) unit."""
        if index not in (0, 1):
            raise ValueError(f"index must be 0 (leading) or 1 (trailing), got {index}")
        units = list(self._units)
        units[index] = unit
        return articulate(units, self.joint, self.name)

    def with_joint(self, joint: Joint | JointKind) -> ArticulatedVehicle:
        """Return the vehicle with another joint, or with the present one of another kind."""
        if isinstance(joint, str):
            joint = dataclasses.replace(self.joint, kind=joint)
        return articulate(self._units, joint, self.name)

    @property
    def title(self) -> str:
        """Title of the file, with "with a sliding bed" added where that holds."""
        return f"{super().title} with a sliding bed" if self.slides else super().title

    @property
    def truss_law(self) -> Mapping[str, float]:
        """Refused: it is asked of one of the units."""
        raise ValueError(f"truss law must be asked of one of the units, got {self.name!r} of two")

    @property
    def kind(self) -> str | None:
        """``"tractor_semitrailer"`` for a tractor with semi-trailer, the truck's for one with a sliding bed.

        Else ``None``.
        """
        if self.slides:
            return self._units[0].kind
        kinds = tuple(unit.kind for unit in self._units)
        return "tractor_semitrailer" if kinds == ("tractor", "semi_trailer") else None

    @property
    def points(self) -> Mapping[str, tuple[float, float, float]]:
        """Refused: each unit has points in its own axes."""
        raise ValueError(f"points must be asked of one of the units, got {self.name!r} of two")

    @property
    def has_file(self) -> bool:
        """Whether both units come from files, so that they can be meshed anew."""
        return all(unit.has_file for unit in self._units)

    @property
    def mesh_density(self) -> float:
        """Number of shell elements relative to the file of the leading unit."""
        return self._units[0].mesh_density

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Vehicle):
            return NotImplemented
        return (
            isinstance(other, ArticulatedVehicle)
            and self.name == other.name
            and self.joint == other.joint
            and all(a == b for a, b in zip(self._units, other._units, strict=True))
        )

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return (articulate, (self._units, self.joint, self.name))

    def __repr__(self) -> str:
        leading, trailing = self._units
        return f"ArticulatedVehicle({self.name!r}, {leading!r}, {trailing!r}, {self.joint.kind})"


def articulate(units: Sequence[Vehicle], joint: Joint, name: str | None) -> ArticulatedVehicle:
    """Return a vehicle of two units; see :meth:`Vehicle.articulated`."""
    if len(units) != 2:
        raise ValueError(f"units must be two, got {len(units)}")
    for i, unit in enumerate(units):
        if not isinstance(unit, Vehicle):
            raise TypeError(f"units[{i}] must be a birm3d.Vehicle, got {type(unit).__name__}")
        if len(unit.units) != 1:
            raise ValueError(f"units[{i}] must be a vehicle of one unit, got {unit.name!r} of two")
    if not isinstance(joint, Joint):
        raise TypeError(f"joint must be a birm3d.Joint, got {type(joint).__name__}")
    leading, trailing = units
    for zone in trailing.zones:
        if zone in leading.zones:
            raise ValueError(f"names of zones must differ between the units, got {zone!r} in both")
    return ArticulatedVehicle(**joined_fields(units, joint, name), _units=(leading, trailing), _joint=joint)


def build(recipe: VehicleRecipe | CombinationRecipe) -> Vehicle:
    """Return the vehicle of a recipe.

    Equal recipes give equal vehicles, to the last bit; those of one file and mesh density share their mesh.

    Raises
    ------
    ValueError
        If a number is out of range; the message names it, the limit and the value.
    """
    if isinstance(recipe, CombinationRecipe):
        return articulate([build(unit) for unit in recipe.units], recipe.joint, recipe.name)
    return Vehicle(**fields_of(recipe))


def _of_read(recipe: VehicleRecipe | CombinationRecipe, gvw: Quantity | None) -> Vehicle:
    """Return the vehicle of a recipe that was read, and warn of a mass that its class can not have."""
    vehicle = build(recipe)
    warn_of_mass(gvw, recipe)
    return vehicle
