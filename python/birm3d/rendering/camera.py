"""Where the camera stands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from ..barrier.surfaces import barrier_axes
from ..pictures import View
from ..plotting.plan_axes import is_oblique
from ..result.skin import Skin
from ..vehicle.unit_shapes import unit_shapes

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["VIEWS", "Camera", "View", "check_view", "driver_camera", "outside_camera"]

Floats = npt.NDArray[np.float64]
VIEWS: tuple[View, ...] = get_args(View)

_LENS = 28.0  # vertical angle of the outer views, deg
_DRIVER_LENS = 62.0
_MARGIN = 1.15
_UP = np.array([0.0, 0.0, 1.0])


class Camera(NamedTuple):
    """Place, what it looks at, what is up in the picture (world axes, m), vertical angle of view [deg].

    With ``half_height`` the view is without perspective: half of what the picture shows vertically [m].
    """

    place: Floats
    target: Floats
    up: Floats
    angle: float
    half_height: float | None = None


def check_view(view: str) -> None:
    """Refuse a view that does not exist."""
    if view not in VIEWS:
        raise ValueError(f"view must be one of {', '.join(VIEWS)}; got {view!r}")


def outside_camera(
    result: Result, view: View, points: Floats, aspect: float, taken: float, crushed: Floats | None = None
) -> Camera:
    """Return a camera that sees all points (k, 3).

    Parameters
    ----------
    result
        Gives the directions of the path and of the barrier.
    view
        ``"three_quarter"``: from above the crushed side, as it stands at the last instant, also through the
        barrier; of a vehicle without crush from above the side of its path. ``"side"``: square to the path,
        from the traffic side, and ``"top"``: from above, the path going to the right, both without
        perspective; ``"front"``: against the path, which a wall would hide.
    points
        World axes [m].
    aspect
        Width of the picture over its height.
    taken
        Share of the picture's width, at its right, that is kept free.
    crushed
        Level direction of the crushed side, see :func:`birm3d.result.crushed_side.crushed_direction`.
    """
    ahead = _path(result)
    left = np.cross(_UP, ahead)
    out = barrier_axes(result.scene.barrier)[1]
    # The side of the path that the barrier does not hide.
    side = left if left @ out >= -1e-9 else -left
    barrier = result.scene.barrier
    ahead_of_it = is_oblique(result) or (barrier is not None and barrier.has_posts)
    aside = side + (0.7 if ahead_of_it else -0.55) * ahead if crushed is None else crushed
    look, up = {
        "three_quarter": (aside + 0.3 * np.linalg.norm(aside) * _UP, _UP),
        "side": (side, _UP),
        "top": (_UP, left),
        "front": (ahead + 0.25 * _UP, _UP),
    }[view]
    back = look / np.linalg.norm(look)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    above = np.cross(back, right)
    # As near as every point allows: half its offset from the axis over the tangent of half the angle.
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    x, y, z = ((points - middle) @ np.stack([right, above, back]).T).T
    x_middle, y_middle = 0.5 * (x.min() + x.max()), 0.5 * (y.min() + y.max())
    slope = np.tan(np.radians(0.5 * _LENS))
    width = aspect * (1.0 - taken)
    near = np.maximum(np.abs(x - x_middle) / width, np.abs(y - y_middle)) / slope + z
    distance = _MARGIN * float(near.max())
    flat = np.maximum(np.abs(x - x_middle) / width, np.abs(y - y_middle))
    half_height = _MARGIN * float(flat.max()) if view in ("side", "top") else None
    # The free share moves what is shown to the left.
    shift = taken * aspect * (slope * distance if half_height is None else half_height)
    target = middle + (x_middle + shift) * right + y_middle * above
    return Camera(target + distance * back, target, above, _LENS, half_height)


def driver_camera(result: Result, skins: Sequence[Skin]) -> Camera:
    """Return the camera of the driver's eyes, which moves with the first unit.

    The eyes are 0.45 m behind the foremost point of the roof, 0.25 m below it and half way to the left side.
    A zone ``cab`` counts as the roof if there is one.
    """
    shape = unit_shapes(result.scene.vehicle)[0]
    nodes = shape.nodes
    if "cab" in shape.zone_names:
        nodes = nodes[shape.zone_of_node == shape.zone_names.index("cab")]
    top, bottom = float(nodes[:, 2].max()), float(shape.nodes[:, 2].min())
    roof = nodes[nodes[:, 2] >= bottom + 0.9 * (top - bottom)]
    eyes = np.array([roof[:, 0].max() - 0.45, 0.4 * roof[:, 1].max(), top - 0.25])
    skin = skins[0]
    place = skin.center + skin.rotation @ eyes
    forward = skin.rotation @ np.array([1.0, 0.0, -0.2])
    return Camera(place, place + 10.0 * forward, skin.rotation @ _UP, _DRIVER_LENS)


def _path(result: Result) -> Floats:
    """Return the direction of the initial path along the ground; of the heading where the vehicle stands."""
    ahead = np.array([*result.velocity[0, :2], 0.0])
    if not np.any(ahead):
        ahead = result.pose(0.0)[1][0] @ np.array([1.0, 0.0, 0.0]) * np.array([1.0, 1.0, 0.0])
    return np.asarray(ahead / np.linalg.norm(ahead))
