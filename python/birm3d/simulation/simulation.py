"""A run: a vehicle, a barrier, a speed and an angle."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from .. import _core, pictures
from .._version import __version__
from ..barrier.barrier import Barrier
from ..base.arguments import checked
from ..base.progress import run_bar
from ..result.result import Result
from ..result.run_warnings import warn_of_run
from ..scene.mesh_check import warn_if_coarse
from ..scene.scene import Scene
from ..scene.settings import Settings
from ..scene.text import pose_text
from ..unit_check import given
from ..units import Quantity, si
from ..vehicle.vehicle import Vehicle

__all__ = ["Simulation", "run_scene"]


@checked
class Simulation:
    """A vehicle that runs into a barrier.

    The vehicle comes along a straight path, its nose ahead unless stated, and stands before the barrier at
    t = 0.

    Seen from above, the barrier's line is a ruler whose zero is its point nearest to the world's origin; at
    heading 0 it is the line x = origin[0], and its marks are y. The path crosses the ruler at the mark
    ``impact_offset``. Where the barrier stands along the ruler is its ``origin``: a pole at origin
    (0, 0.6, 0) is met 0.6 m beside the vehicle's middle. A barrier that is moved across its line takes its
    ruler along, and the vehicle still starts ``standoff`` before it. To move a whole scene, or to aim at a
    point of a site plan, give ``impact_offset=barrier.station(point)``, see
    :meth:`birm3d.Barrier.station`.

    Numbers are SI and degrees; text with a unit says another, as ``impact_speed="30 mph"``.

    One thread uses a simulation at a time; any other gets a :class:`birm3d.BusyError`. A copy
    (``copy.copy``) has the same state and is independent. A pickle keeps the state too: it holds the scene
    and the number of steps. They are taken again when it is read, and the hash of the state is compared.

    Parameters
    ----------
    vehicle
        See :class:`birm3d.Vehicle`.
    barrier
        See :class:`birm3d.Barrier`; ``None`` for a vehicle on its own (then give ``duration``).
    impact_speed
        [m/s], >= 0.
    impact_angle
        Between the vehicle's path and the barrier's line [deg], 0 to 180; 90 is head-on. At 0 and 180 the
        barrier must have an end to meet.
    impact_offset
        Where the path of the mass centre (of the leading unit) meets the barrier's line [m], counted from the
        line's point nearest to the world's origin. At angles 0 and 180 the distance of the path from the
        line, positive behind it: half the thickness leads to the middle of a wall's end.
    standoff
        Distance of the nearest node from the barrier at t = 0 [m], >= 0.
    impact_yaw
        By which the nose points to the left of the path at t = 0 [deg]; at 90 the right side goes ahead.
    impact_roll
        At t = 0 [deg], positive to the right.
    duration
        [s]; ``None``: until the outcome is decided.
    settings
        See :class:`birm3d.Settings`.
    overlap
        Share of the vehicle's width that meets the barrier, above 0 to 1, in place of ``impact_offset``. Seen
        along the path the barrier's end stands that far inside the skin of the (leading) unit. ``None``: the
        path is that of ``impact_offset``.
    overlap_side
        Of the vehicle, from which the overlap is counted, "left" or "right".

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value received.
    UnitWarning
        As a warning, if a number is most likely in another unit, as an impact_speed of 50 (180 km/h).
    CoarseSkinWarning
        As a warning, if the barrier is so narrow that it can pass between the nodes of the skin.
    """

    _leads_to: ClassVar = {"Result": "its run() returns one"}

    def __init__(
        self,
        vehicle: Vehicle,
        barrier: Barrier | None,
        impact_speed: Quantity,
        impact_angle: Quantity = 90.0,
        impact_offset: Quantity = 0.0,
        *,
        standoff: Quantity = 0.0,
        impact_yaw: Quantity = 0.0,
        impact_roll: Quantity = 0.0,
        duration: Quantity | None = None,
        settings: Settings | None = None,
        overlap: float | None = None,
        overlap_side: str = "left",
    ) -> None:
        scene = Scene(
            vehicle,
            barrier,
            given("impact_speed", impact_speed),
            given("impact_angle", impact_angle),
            si("impact_offset", impact_offset, "length"),
            given("standoff", standoff),
            given("impact_yaw", impact_yaw),
            given("impact_roll", impact_roll),
            None if duration is None else given("duration", duration),
            settings if settings is not None else Settings(),
            None if overlap is None else float(overlap),
            overlap_side,
        )
        self._begin(scene)

    def _begin(self, scene: Scene) -> None:
        self._scene = scene
        self._core = scene.start()
        self._run_time = 0.0
        warn_if_coarse(self._scene)

    @staticmethod
    def from_scene(scene: Scene) -> Simulation:
        """Return the simulation of a scene, such as that of a loaded result."""
        simulation = object.__new__(Simulation)  # its numbers were checked: no second warning of their unit
        simulation._begin(scene)
        return simulation

    @property
    def scene(self) -> Scene:
        """What the run is about."""
        return self._scene

    @property
    def time(self) -> float:
        """Present time of the state [s]."""
        with self._core:
            return self._core.time

    def run(self, *, frames: int | Sequence[float] | None = None, progress: bool | None = False) -> Result:
        """Run from the present state to the end; a run that is over starts anew.

        Ctrl-C stops it between two steps; called again, it goes on from there.

        Parameters
        ----------
        frames
            Number or instants [s] of the skin's positions that the result keeps for pictures, see
            :meth:`birm3d.Result.with_frames`; ``None``: none, at no cost.
        progress
            Whether a run of over a second shows a bar; ``None``: if stderr is a terminal, and in notebooks.

        Raises
        ------
        UnstableError
            If a fixed time step is beyond what the scene allows; the message names one that would do.
        BusyError
            If another thread uses the simulation.
        OverlapWarning, CoreContactWarning
            As warnings, if the rigid body got more than 0.1 m into the barrier, or was pressed with more than
            the vehicle's weight as a mean over 50 ms.
        BalanceWarning, MissedBarrierWarning
            As warnings, if a balance does not close, or the vehicle went past the barrier's end untouched.
        LowBarrierWarning, LeaningPostWarning, TippingWarning
            As warnings, if a barrier that contains a front is low, posts that lean threw the vehicle up, or a
            free-standing segment would begin to tip.
        ValueError
            If the frames are more than the result's rows or outside the run, or if the run takes more steps
            than a record holds; :meth:`result` has those that were taken.
        """
        with run_bar(progress, self._scene.duration) as tick:
            result = self._run(tick)
        return result if frames is None else result.with_frames(frames)

    def _run(self, tick: Callable[[Any, Any], None] | None) -> Result:
        """Run to the end as :meth:`run` does; `tick` is called now and then with the time [s] and steps."""
        with self._core:
            if self._core.failed or self._core.end_reason != _core.EndReason.running:
                self._reset()
            start = time.perf_counter()
            try:
                self._core.run(tick)
            finally:
                self._run_time += time.perf_counter() - start
            result, balances = self._result(), self._core.balances
        warn_of_run(result, balances)
        return result

    def step(self) -> bool:
        """Take one accepted step; return ``False`` when the run is over and nothing was done."""
        with self._core:
            start = time.perf_counter()
            moved = self._core.step()
            self._run_time += time.perf_counter() - start
        return moved

    def result(self) -> Result:
        """Return the result so far."""
        with self._core:
            return self._result()

    def _result(self) -> Result:
        return Result._of(self._scene, self._core, self._run_time)

    def reset(self) -> None:
        """Go back to t = 0."""
        with self._core:
            self._reset()

    def _reset(self) -> None:
        self._core.reset()
        self._run_time = 0.0

    def state_hash(self) -> int:
        """Return a 64-bit hash of bodies, wheels, trusses, indentations, energies; not of the last loads."""
        with self._core:
            return self._core.state_hash

    def snapshot(self) -> _core.Snapshot:
        """Return a checkpoint: the whole state and the record so far."""
        with self._core:
            return self._core.snapshot()

    def restore(self, snapshot: _core.Snapshot) -> None:
        """Go back to a checkpoint of the same scene; its duration may differ.

        Raises
        ------
        ValueError
            If the snapshot is of another vehicle or barrier, of another approach, of other settings, or of an
            instant beyond the duration of this run.
        """
        with self._core:
            self._core.restore(snapshot)

    def __copy__(self) -> Simulation:
        """Return a simulation of the same scene in the same state, for another thread or another end."""
        twin = self._at_start()
        with self._core:
            twin._core.restore(self._core.snapshot())
            twin._run_time = self._run_time
        return twin

    def _at_start(self) -> Simulation:
        """Return another one of the same scene, at t = 0; what the first one warned of is not said again."""
        twin = object.__new__(Simulation)
        twin._scene, twin._core, twin._run_time = self._scene, self._scene.start(), 0.0
        return twin

    def __deepcopy__(self, memo: dict[int, object]) -> Simulation:
        return self.__copy__()  # a scene is immutable

    def __reduce__(self) -> tuple[object, ...]:
        with self._core:
            steps = self._core.statistics.steps
            if steps == 0:
                return (Simulation.from_scene, (self._scene,))
            if not self._core.replays:
                raise ValueError(
                    "simulation must have come to its state by steps of its own to be pickled, got one "
                    "restored from a run of another duration; copy.copy() keeps the state"
                )
            return (_stepped, (self._scene, steps, self._core.state_hash, __version__))

    def _repr_html_(self) -> str:
        return pictures.scene_html(self._scene)

    def __repr__(self) -> str:
        scene = self._scene
        approach = f"{scene.impact_speed:g} m/s, {scene.impact_angle:g} deg{pose_text(scene)}"
        return f"Simulation({scene.vehicle.name}, {scene.barrier}, {approach})"


def run_scene(scene: Scene) -> Result:
    """Return the result of a scene, without the warnings that its first run gave."""
    core = scene.start()
    with core:
        core.run()
        return Result._of(scene, core, 0.0)


def _stepped(scene: Scene, steps: int, state_hash: int, version: str) -> Simulation:
    """Return a simulation in the state that it was pickled in: as many steps lead to the same bits."""
    simulation = Simulation.from_scene(scene)
    while simulation._core.statistics.steps < steps and simulation.step():
        pass
    if simulation.state_hash() != state_hash:
        raise ValueError(
            f"simulation must be unpickled by the version that pickled it (birm3d {version}) to come to the "
            f"same state after {steps} steps, got birm3d {__version__}"
        )
    return simulation
