"""The result of a run: histories, scalars, a report, a table, pictures and a file."""

from __future__ import annotations

import copy
import io
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy.typing as npt

from .. import _core, pictures
from .._version import __version__
from ..base.arguments import checked
from ..io.file_format import reads
from ..scene.scene import Scene
from ..units import Quantity
from . import capsule as capsules
from . import result_file
from . import table as result_table
from .analysis import RunAnalysis
from .capture import capture
from .computed_cells import load_map
from .load_map import LoadMap
from .report import report
from .sensor import Sensor, place_sensor
from .unit_result import UnitResult

__all__ = ["Result", "load", "write_capsule"]


@checked
class Result(RunAnalysis):
    """Histories of n rows at the output interval, and what follows from them.

    Arrays are read-only views, SI, angles in degrees. Positions and velocities hold at the row's instant.
    Accelerations, forces and reactions are means over the interval that ends there (the first row: that
    begins there). So they add up to the change of velocity exactly.

    Attributes
    ----------
    scene : Scene
    statistics : StepStatistics
        Steps taken, node evaluations, shortest and longest step.
    end_reason : str
        ``"separated"``, ``"stopped"``, ``"sliding"``, ``"duration"``, ``"longest"`` or ``"running"``.
    state_hash : int
        Of the final state.
    run_time : float
        Wall time of the stepping [s].
    nodes, deflection, peak_deflection : ndarray
        Shell nodes in body axes (k, 3), truss deflections (k,) at the end and their peaks [m].
    frames : Frames or None
        Places of the shell nodes over time, see :meth:`with_frames`.
    made_with : mapping of str to str
        Versions, source and platform that computed the result; of a file, as far as that says.
    version : str
        Of the package that computed the result.

    Notes
    -----
    Motions, ``nodes`` and deflections are those of unit 0, the leading one; forces of the barrier and of the
    ground are those on all units together. :meth:`unit` has both for each unit.
    """

    plot = pictures.plot
    plot_histories = pictures.plot_histories
    plot_plan = pictures.plot_plan
    plot_crush = pictures.plot_crush
    plot_elements = pictures.plot_elements
    render = pictures.render
    animate = pictures.animate
    show = pictures.show
    write_html = pictures.write_html
    write_gltf = pictures.write_gltf
    write_vtk = pictures.write_vtk
    to_dataframe = result_table.to_dataframe

    @classmethod
    def _of(cls, scene: Scene, simulation: _core.Simulation, run_time: float) -> Result:
        history = simulation.history()
        units = tuple(
            UnitResult(
                history.unit(u),
                nodes=simulation.nodes(u),
                deflection=simulation.deflection(u),
                peak_deflection=simulation.peak_deflection(u),
                final_velocity=simulation.velocity(u),
            )
            for u in range(len(scene.vehicle.units))
        )
        return cls(
            scene=scene,
            history=history,
            statistics=simulation.statistics,
            end_reason=simulation.end_reason.name,
            state_hash=simulation.state_hash,
            run_time=run_time,
            units=units,
            event=simulation.event,
        )

    def report(self) -> str:
        """Return what was computed, what was left out, and how the balances close, as text."""
        return self._report

    @cached_property
    def _report(self) -> str:
        return report(self)

    def sensor(self, point: str | Sequence[Quantity], part: str | int | None = None) -> Sensor:
        """Return the motion of a point that is fixed to the vehicle, as a gauge there would record it.

        Parameters
        ----------
        point
            Name of a point (:attr:`birm3d.Vehicle.points`), as ``"load_bed_leading_edge"``, or its place (x,
            y, z) [m]. The axes are those of the vehicle's file: forward, left, up, origin on the ground below
            the front axle.
        part
            Of a vehicle of two units: the name of one of them, or its number. ``None``: the unit that has
            a point of this name, else the leading one.

        Raises
        ------
        ValueError
            If there is no such point or part; the message names those that there are.
        UnitWarning
            As a warning, if a place in plain numbers is more than 1 m outside the box about the part's skin.
        """
        return place_sensor(self, point, part)

    def load_map(
        self,
        cell: Quantity | None = None,
        *,
        lateral: npt.ArrayLike | None = None,
        height: npt.ArrayLike | None = None,
    ) -> LoadMap:
        """Return the force on the cells of a grid over a fixed barrier.

        How it is found says :func:`birm3d.result.computed_cells.load_map`.

        Parameters
        ----------
        cell
            Side of the square cells [m]; ``None``: 0.25 m, more in long runs.
        lateral, height
            Increasing edges of the cells, instead of square ones, along the barrier's line and above its foot
            [m].

        Raises
        ------
        ValueError
            If the barrier is a mesh, stands free or has several rows of posts. If the cells are too small or
            do not increase.
        """
        return load_map(self, cell, lateral=lateral, height=height)

    def with_frames(self, frames: int | Sequence[float] = 61) -> Result:
        """Return the same result with places of the shell nodes over time, for pictures.

        The scene is run once more, which must end in the same bits.

        Parameters
        ----------
        frames
            A number of instants, spread over the run and among its rows, or the instants [s].

        Raises
        ------
        ValueError
            If the instants are outside the run, or the scene does not run the same way again.
        """
        other = copy.copy(self)
        other.frames = capture(self, frames)
        if self.version == __version__:  # a report of another version stays as it was
            other.__dict__.pop("_report", None)  # it says that there were no frames
        return other

    def save(self, path: str | Path) -> None:
        """Write everything to one npz file that :func:`birm3d.load` reads; :mod:`birm3d.result.result_file`.

        Raises
        ------
        ValueError
            If the path is a folder or lies in none.
        """
        result_file.save(self, self._text_of_file(), path)

    def capsule(self, path: str | Path) -> None:
        """Write one file that runs again to the same bits: scene, vehicle, settings, versions, state hash.

        ``birm3d rerun FILE`` and :func:`birm3d.rerun` run it again and compare; :func:`load` reads it too.
        The format is that of :mod:`birm3d.result.capsule`; the usual ending is ``.birm3d``.

        Raises
        ------
        ValueError
            If the scene does not run again to the same bits, as may happen with a result of another version.
            If the path is a folder or lies in none.
        """
        capsules.write(self, self._text_of_file(), path)

    def __reduce__(self) -> tuple[Any, ...]:
        stream = io.BytesIO()
        result_file.write(self, self._text_of_file(), stream)
        return (_from_bytes, (stream.getvalue(),))

    def _text_of_file(self) -> str | None:
        """Report for the file; a run of one row has no metrics, so it has none."""
        return self.report() if len(self.time) > 1 else None

    def _repr_html_(self) -> str:
        """Return what notebooks show: outcome, headline numbers, a small plan view."""
        return pictures.result_html(self)

    def __repr__(self) -> str:
        rows, steps = len(self.time), self.statistics.steps
        return f"Result({self.outcome}, {rows} rows to {self.time[-1]:g} s, {self.end_reason}, {steps} steps)"


@reads("must be a file of Result.save(), npz, or a capsule")
def load(path: str | Path) -> Result:
    """Read a result that :meth:`Result.save` or :meth:`Result.capsule` wrote; its scene can be run again.

    Raises
    ------
    FileFormatError
        If the file can not be read, is no result, is damaged or was changed, or is of a newer version.
    """
    path = Path(path)
    with path.open("rb") as stream:
        if capsules.is_capsule(stream):
            capsule = capsules.read(stream, path)
            return _of_file(capsule.parts, capsule.report)
        return _of_file(*result_file.read(stream, path))


@checked
def write_capsule(result: Result, path: str | Path) -> None:
    """Write the capsule of a result; see :meth:`Result.capsule`.

    Raises
    ------
    ValueError
        As :meth:`Result.capsule` does.
    """
    result.capsule(path)


def _from_bytes(content: bytes) -> Result:
    """Return the result of a file that is in memory; a pickle is such a file."""
    return _of_file(*result_file.read(io.BytesIO(content), Path("result")))


def _of_file(parts: dict[str, Any], report: str | None) -> Result:
    result = Result(**parts)
    if report is not None:
        result.__dict__["_report"] = report  # as it was then
    return result
