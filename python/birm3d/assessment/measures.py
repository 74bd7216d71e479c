"""What standards measure between a vehicle and a barrier: penetration, deflection, intrusion, exit box."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..barrier.kinds import RigidWall
from ..barrier.surfaces import barrier_axes, barrier_surfaces
from ..result.capture import capture
from ..result.event import gets_past
from ..result.metrics import ALONG_LINE
from ..result.sensor import place_sensor
from ..units import Stated
from ..vehicle.unit_shapes import unit_shapes
from .criteria import Criterion

if TYPE_CHECKING:
    from ..barrier import Barrier
    from ..result import Result
    from ..units import Quantity

__all__ = [
    "ExitBox",
    "Extent",
    "barrier_extent",
    "exit_box",
    "heading_rows",
    "movement_rows",
    "penetration_history",
    "vehicle_intrusion",
]

Floats = npt.NDArray[np.float64]

# Frames at which the vehicle's intrusion is looked at.
_FRAMES = 121


class Extent(NamedTuple):
    """Across the barrier from its line, away from the traffic, before the impact [m].

    front: the traffic face, of posts their side that looks to the traffic. rear: the protected face.
    """

    front: float
    rear: float


def barrier_extent(barrier: Barrier) -> Extent:
    """Return where a barrier begins and ends across its line; a wall without end is as thick as it says."""
    if isinstance(barrier, RigidWall):
        return Extent(0.0, barrier.thickness)
    origin = np.asarray(barrier.origin)
    points = np.vstack([vertices for vertices, _ in barrier_surfaces(barrier, [origin])])
    across = (points - origin) @ np.asarray(barrier._past)
    return Extent(float(across.min()), float(across.max()))


def across_barrier(result: Result, points: Floats) -> Floats:
    """Return how far points (..., 3) of the world are past the barrier's line [m]."""
    barrier = _barrier_of(result)
    distance: Floats = (points - np.asarray(barrier.origin)) @ np.asarray(barrier._past)
    return distance


def penetration_history(
    result: Result, point: str | Sequence[Quantity], part: str | int | None, datum: float
) -> Floats:
    """Return how far a point of the vehicle, or its mirror image, is past a datum over time, shape (n,) [m].

    Parameters
    ----------
    point, part
        See :meth:`birm3d.Result.sensor`. Of a point and its mirror image about the vehicle's middle plane
        the further one counts: an edge or a pillar has two ends.
    datum
        Across the barrier from its line [m].
    """
    right = place_sensor(result, point, part, "reference_point")
    x, y, z = map(Stated, right.point)  # no second UnitWarning of the same point
    left = place_sensor(result, (x, Stated(-y), z), right.part)
    both = [across_barrier(result, sensor.position) for sensor in (right, left)]
    return np.maximum(*both) - datum


def check_side_on(result: Result) -> None:
    """Refuse a path along the barrier's line, on which nothing is measured across it.

    Raises
    ------
    ValueError
        Naming the angle; or if there is no barrier.
    """
    _barrier_of(result)
    angle = result.scene.impact_angle
    if abs(math.sin(math.radians(angle))) < ALONG_LINE:
        raise ValueError(f"impact_angle must lead across the barrier's line for a rating, got {angle:g} deg")


def movement_rows(result: Result) -> Iterator[Criterion]:
    """Yield how far a barrier gives way that yields or stands free: reported, not judged."""
    metrics = result.metrics
    if "barrier_deflection" in metrics:
        yield Criterion("dynamic deflection", float(metrics["barrier_deflection"]), "m", "", None)
    if "post_tilt" in metrics:
        yield Criterion("greatest tilt of a post", float(metrics["post_tilt"]), "deg", "", None)


def heading_rows(result: Result, most: float) -> list[Criterion]:
    """Return the criterion that the vehicle goes upright along its own axis; none where it does exactly.

    A test's vehicle tracks: its front strikes. most: greatest yaw and roll at impact [deg].
    """
    scene = result.scene
    if scene.impact_yaw == 0.0 and scene.impact_roll == 0.0:
        return []
    yaw = (scene.impact_yaw + 180.0) % 360.0 - 180.0
    value = f"{yaw:g}, {scene.impact_roll:g} deg"
    met = max(abs(yaw), abs(scene.impact_roll)) <= most
    return [Criterion("yaw and roll at impact", value, "", f"0 +-{most:g} deg, the front ahead", met)]


def vehicle_intrusion(result: Result) -> float:
    """Return how far any part of the vehicle got past the undeformed traffic face [m]; 0 if none did.

    Crushed nodes of the skin at some 120 instants, for which the scene is run once more where the result has
    no frames. Of a vehicle that is contained, parts beyond the barrier's ends do not count.
    """
    extent = barrier_extent(_barrier_of(result))
    frames = result.frames
    if frames is None:
        frames = capture(result, min(_FRAMES, len(result.time)))
    rows = np.minimum(np.searchsorted(result.time, frames.time), len(result.time) - 1)
    across = np.asarray(_barrier_of(result)._past)
    line, (low, high) = barrier_axes(_barrier_of(result))[0], _ends(result)
    furthest = 0.0
    for unit, shape in enumerate(unit_shapes(result.scene.vehicle)):
        centers, rotations = _poses(result, unit, rows)
        start = across_barrier(result, centers) - extent.front
        for k in range(len(frames)):
            nodes = shape.nodes + frames.displacement[unit][k]
            along = centers[k] @ line + nodes @ (rotations[k].T @ line)
            beside = nodes[(along >= low) & (along <= high)]
            reach = (beside @ (rotations[k].T @ across)).max(initial=-math.inf)
            furthest = max(furthest, float(start[k] + reach))
    return furthest


def _ends(result: Result) -> tuple[float, float]:
    """Return between which places along the line intrusion counts [m]."""
    if gets_past(result):
        return -math.inf, math.inf
    barrier = _barrier_of(result)
    line = barrier_axes(barrier)[0]
    path = np.vstack([result.unit(i).position for i in range(len(result.scene.vehicle.units))])
    # Barriers without end are drawn past these points.
    reach = result.scene.vehicle.length * line
    surfaces = barrier_surfaces(barrier, np.concatenate([path - reach, path + reach]))
    along = np.concatenate([vertices @ line for vertices, _ in surfaces])
    return float(along.min()), float(along.max())


class ExitBox(NamedTuple):
    """Box beside the barrier that wheels may not leave sideways after the last contact.

    width, length: of the box, from the traffic face and from the last contact [m]. reached: greatest distance
    of a wheel from the traffic face within that length [m].
    """

    width: float
    length: float
    reached: float

    @property
    def inside(self) -> bool:
        """Whether all wheels stay within."""
        return self.reached <= self.width


def exit_box(result: Result, heavy: bool) -> ExitBox:
    """Return the exit box of EN 1317-2 and MASH, and the greatest distance of a wheel within its length.

    Its width is 2.2 m, of heavy vehicles 4.4 m, and the vehicle's width and 16 % of its length; it is 10 m
    long, of heavy vehicles 20 m. Beyond the end of the run the vehicle goes straight on as it moved then.
    A vehicle that does not leave the barrier is inside.
    """
    vehicle = result.scene.vehicle
    length = 20.0 if heavy else 10.0
    width = (4.4 if heavy else 2.2) + vehicle.width + 0.16 * vehicle.length
    left = result.metrics.get("time_of_separation")
    barrier = _barrier_of(result)
    past = np.asarray(barrier._past)
    along = np.cross([0.0, 0.0, 1.0], past)
    along *= math.copysign(1.0, float(result.velocity[0] @ along))
    start = 0 if left is None else int(np.searchsorted(result.time, left))
    extent = barrier_extent(barrier)
    rows = slice(min(start, len(result.time) - 1), None)
    tracks = np.concatenate([_wheel_tracks(result, unit, rows) for unit in range(len(vehicle.units))])
    tracks = tracks - np.asarray(barrier.origin)
    out, ahead = extent.front - tracks @ past, tracks @ along
    if left is None:
        return ExitBox(width, length, float(out[:, -1].max()))
    nearest = int(np.argmin(out[:, 0]))
    ahead = ahead - ahead[nearest, 0]
    reached = float(np.where(ahead <= length, out, -math.inf).max())
    # Straight on from the last row, wheel by wheel, to the end of the box. Wheels beyond it are left out.
    outward, forward = -float(result.velocity[-1] @ past), float(result.velocity[-1] @ along)
    inside = ahead[:, -1] <= length
    if forward > 0.0 and inside.any():
        remaining = (length - ahead[inside, -1]) / forward
        reached = max(reached, float((out[inside, -1] + outward * remaining).max()))
    return ExitBox(width, length, reached)


def _poses(result: Result, unit: int, rows: Any) -> tuple[Floats, Floats]:
    """Return mass centres (k, 3) [m] and rotations body to world (k, 3, 3) of a unit at some rows."""
    sensor = result.sensor("mass_center", unit)
    return sensor.position[rows], sensor.rotation_at(rows)


def _wheel_tracks(result: Result, unit: int, rows: slice) -> Floats:
    """Return where the wheels of a unit are, shape (wheels, rows, 3) [m]."""
    centers, rotations = _poses(result, unit, rows)
    wheels = result.scene.vehicle.units[unit].wheels[:, :3]
    tracks: Floats = centers[None] + np.einsum("nij,wj->wni", rotations, wheels)
    return tracks


def _barrier_of(result: Result) -> Barrier:
    if result.scene.barrier is None:
        raise ValueError("result must have a barrier to be rated, got None")
    return result.scene.barrier
