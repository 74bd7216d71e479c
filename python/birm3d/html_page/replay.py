"""Numbers of the three-dimensional replay: skin, wheels and barrier at some instants, packed for a page."""

from __future__ import annotations

import base64
import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..barrier.surfaces import barrier_axes, barrier_surfaces
from ..result.crushed_side import crushed_direction
from ..result.element_motion import element_motion
from ..result.skin import Skin, skins_at
from ..vehicle.unit_shapes import UnitShape, unit_shapes

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["CRUSH_COLORS", "replay_data", "replay_times"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

CRUSH_COLORS = ("#DCE2E8", "#FFE08A", "#FDAE4B", "#E8502E", "#B0101A", "#5E0008")
"""Of the skin: grey where there is no crush, so that little of it shows too."""

_LEAST_SCALE = 0.05  # the colours of crush range over this at least, m
_STEP = 1e-3  # packed lengths are whole numbers of these, m
_MOVES = 5e-4  # a node that moves by less stays, m
_AROUND = 6.0  # the ground goes on so far past what is shown, m
_MARGIN = 1.25  # width of the picture over the width of what is shown
_FAR = 3.0  # a vehicle that goes further than so many of its lengths is followed by the camera
_HALF_ANGLE = 0.3  # half of the camera's angle of view, rad; the same number is in replay.js


def replay_times(result: Result, frames: int) -> Floats:
    """Return the instants of the frames [s]: two thirds of them until a little after the separation."""
    end = float(result.time[-1])
    parted = min(end, 1.1 * result.metrics["time_of_separation"]) if _parts(result) else end
    if parted > 0.6 * end:
        return np.linspace(float(result.time[0]), end, frames)
    near = max(2, (2 * frames) // 3)
    times = [np.linspace(float(result.time[0]), parted, near), np.linspace(parted, end, frames - near + 1)]
    return np.unique(np.concatenate(times))


def _parts(result: Result) -> bool:
    return "time_of_separation" in result.metrics


def replay_data(result: Result, frames: int = 60) -> dict[str, Any]:
    """Return what replay.js draws: lengths of the vehicle in 16 bits, only of nodes that move.

    Parameters
    ----------
    result
        The run; one without frames is run once more.
    frames
        Number of instants, >= 2; the replay is linear between them.

    Raises
    ------
    ValueError
        If there are fewer than 2 frames, or the scene does not run the same way again.
    """
    if frames < 2:
        raise ValueError(f"frames must be >= 2, got {frames}")
    times = replay_times(result, frames)
    skins = skins_at(result, times)
    shapes = unit_shapes(result.scene.vehicle)
    corners = [np.unique(shape.quads) for shape in shapes]
    world = np.vstack(
        [
            skin.world[shown] if len(shown) else skin.world
            for one in skins
            for skin, shown in zip(one, corners, strict=True)
        ]
    )
    crushed = [
        float(skin.crush[shown].max(initial=0.0))
        for one in skins
        for skin, shown in zip(one, corners, strict=True)
    ]
    deepest = [max(crushed[k * len(shapes) : (k + 1) * len(shapes)]) for k in range(len(times))]
    instant = int(np.argmax(np.array(deepest) >= 0.999 * max(deepest)))
    low, high = np.floor(world.min(axis=0) - _AROUND), np.ceil(world.max(axis=0) + _AROUND)
    return {
        "unit": _STEP,
        "time": [round(1e3 * float(t), 3) for t in times],
        "instant": round(1e3 * float(times[instant]), 3),
        "units": [_unit(shape, [one[i] for one in skins]) for i, shape in enumerate(shapes)],
        "barrier": _barrier(result, times, world),
        "hasGround": bool(result.scene.settings.ground),
        "ground": [low[:2].tolist(), high[:2].tolist()],
        "greatest": max(_LEAST_SCALE, *crushed),
        "colors": list(CRUSH_COLORS),
        **_cameras(result, skins, world, instant),
    }


def _packed(lengths: npt.ArrayLike) -> str:
    return _text(np.round(np.asarray(lengths, float) / _STEP).astype("<i2"))


def _text(array: npt.NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")


def _unit(shape: UnitShape, skins: list[Skin]) -> dict[str, Any]:
    from scipy.spatial.transform import Rotation

    moved = np.stack([skin.displacement for skin in skins])
    moving = np.flatnonzero(np.abs(moved).max(axis=(0, 2)) > _MOVES)
    quaternions = Rotation.from_matrix(np.stack([skin.rotation for skin in skins])).as_quat()[:, [3, 0, 1, 2]]
    for before, after in itertools.pairwise(quaternions):  # the shorter way between two frames
        after *= math.copysign(1.0, float(before @ after))
    faces = np.vstack([shape.quads[:, [0, 1, 2]], shape.quads[:, [0, 2, 3]]])
    return {
        "rest": _packed(shape.nodes),
        "faces": _text(faces.astype("<u4")),
        "moving": _text(moving.astype("<u4")),
        "moved": _packed(moved[:, moving]),
        "center": np.round([skin.center for skin in skins], 4).tolist(),
        "rotation": np.round(quaternions, 6).tolist(),
        "wheels": np.round(shape.wheels, 4).tolist(),
    }


def _barrier(result: Result, times: Floats, world: Floats) -> list[dict[str, Any]]:
    """Return the surfaces of the barrier; elements that move with where they are over time."""
    parts: list[dict[str, Any]] = []
    motion = element_motion(result, times)
    for i, (vertices, faces) in enumerate(barrier_surfaces(result.scene.barrier, world)):
        part: dict[str, Any] = {
            "vertices": _text(np.asarray(vertices, "<f4")),  # they may be further off than 16 bits reach
            "faces": _text(faces.astype("<u4")),
        }
        if i < motion.movable:
            part["center"] = np.round(motion.center[i], 4).tolist()
            part["shift"] = np.round(motion.shift[:, i], 4).tolist()
            part["turn"] = np.round(motion.turn[:, i].reshape(-1, 9), 6).tolist()
        parts.append(part)
    return parts


def _cameras(result: Result, skins: list[tuple[Skin, ...]], world: Floats, instant: int) -> dict[str, Any]:
    """Return the points that are looked at over the frames, the camera at first, and others by name.

    A vehicle that goes far is followed, as it would be a dot in a picture of its whole path. The camera
    stands where the greatest crush shows, and sees through walls, which would hide it.
    """
    barrier = result.scene.barrier
    along, out, _ = barrier_axes(barrier)
    oblique = not 45.0 <= result.scene.impact_angle <= 135.0
    low, high = world.min(axis=0), world.max(axis=0)
    targets = np.array([[*(0.5 * (low + high))[:2], 0.35 * (low[2] + high[2])]])
    near = np.vstack([skin.world for skin in skins[instant]])
    long = float(np.linalg.norm(np.ptp(near[:, :2], axis=0)))
    followed = float(np.linalg.norm((high - low)[:2])) > _FAR * long
    if followed:
        middles = [np.mean([skin.center for skin in one], axis=0) for one in skins]
        targets = np.array([[x, y, targets[0, 2]] for x, y, _ in middles])
        low, high = near.min(axis=0), near.max(axis=0)
    radius = 0.5 * float(np.linalg.norm(high - low))
    far = _MARGIN * radius / math.tan(_HALF_ANGLE)
    seen = crushed_direction(result, skins[instant])
    if seen is not None:
        first = seen
    elif oblique:  # from where it goes: the struck corner shows
        ahead = math.copysign(1.0, float(result.velocity[0] @ along))
        first = 0.55 * out + 0.9 * ahead * along
    else:
        first = along + 0.45 * out
    posts = barrier is not None and barrier.has_posts
    beside = out if oblique else along
    towards = along if oblique else out
    return {
        "targets": np.round(targets, 3).tolist(),
        "camera": {
            "around": math.atan2(first[1], first[0]),
            "up": 0.42,
            "far": (1.0 if followed else 0.55 if oblique else 0.8) * far,
        },
        "seeThrough": seen is not None and barrier is not None and not posts,
        "views": {
            "three quarters": {},
            "side": {"around": math.atan2(beside[1], beside[0]), "up": 0.05},
            "above": {"around": math.atan2(out[1], out[0]), "up": 1.5},
            "along the path": {"around": math.atan2(towards[1], towards[0]), "up": 0.12},
        },
    }
