"""Vehicles: a rigid body, its crushable skin and its wheels."""

# Longer than 300 lines: what users read of a vehicle, its fields and how one is made.
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..base.arguments import checked
from ..base.checks import array
from ..units import Quantity, si
from .old_names import OldVehicleNames
from .zone import TRUSS_LAW, Zone

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .articulated import ArticulatedVehicle
    from .joint import Joint

__all__ = ["TRUSS_LAW", "Vehicle", "Zone"]

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
        (:mod:`birm3d.vehicle.along_panel`), then of the treads by which tyres meet barriers
        (:mod:`birm3d.vehicle.tire_nodes`).
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
        from .builder import read_preset

        return read_preset(name, gvw, mesh_density)

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
        from .builder import read
        from .vehicle_file import VehicleFileError

        try:
            return read(path, gvw, mesh_density)
        except VehicleFileError:
            raise
        except (ValueError, TypeError, ArithmeticError, LookupError, AttributeError):
            # Is it the file or the arguments? Without them a good file gives a vehicle.
            with reading(path, "must be a vehicle", VehicleFileError):
                read(path, None, 1.0)
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
        words and numbers, and so do the report of a run and the vehicle's file. :attr:`scatter` has the bands
        that :func:`birm3d.predict` draws from.

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
        from .from_facts import vehicle_of_facts

        sizes = {"length": length, "width": width, "height": height, "wheelbase": wheelbase}
        return vehicle_of_facts(kind, mass, sizes, mass_center_height, mesh_density)

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
        from .mesh_import.vehicle_of_mesh import vehicle_of_mesh

        others = {
            "kind": kind, "unit": unit, "forward": forward, "up": up, "holes": holes, "parts": parts,
            "without_parts": without_parts, "clearance": clearance, "element_size": element_size,
            "wheelbase": wheelbase, "front_overhang": front_overhang, "wheel_radius": wheel_radius,
            "track": track, "mass_center_height": mass_center_height, "center_of_mass": center_of_mass,
            "inertia": inertia, "use_densities": use_densities, "zones": zones, "core": core, "name": name,
        }  # fmt: skip
        return vehicle_of_mesh(MeshFacts.given(path, mass, like, others), mesh_density)

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
        C++ gives the same bits. The cornering stiffness of tyres is a setting there, see
        :attr:`birm3d.simulation.Scene.cornering_stiffness`.

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
        from .articulated import articulate

        return articulate(units, joint, name)
