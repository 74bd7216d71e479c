"""In what two scenes are alike, and how far apart they are: which given tests say something of a scene."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from ..barrier import Barrier
from ..barrier.kinds import Jersey, MeshBarrier

if TYPE_CHECKING:
    from ..scene.scene import Scene

__all__ = ["Facts", "Family", "distance", "likeness", "same_group", "side_of"]

Family: TypeAlias = Literal["wall", "posts", "concrete", "other", "none"]

_GROUPS = (
    ("car", "minivan"),
    ("pickup", "van"),
    ("truck", "cab_over_truck", "bus"),
    ("tractor_semitrailer", "tractor", "semi_trailer"),
)
_SPEED, _ANGLE = 0.1, 5.0  # speeds (relative) and angles [deg] that differ by less are called the same
# Differences of this size count 1: logarithms of the ratio of speeds and of masses, and angles [deg].
_SPEED_SCALE, _ANGLE_SCALE, _MASS_SCALE = 0.4, 30.0, 0.8
_OTHER_KIND, _OTHER_GROUP, _OTHER_FAMILY, _OTHER_SIDE = 0.3, 1.0, 1.0, 1.0
_LEAST_SPEED = 0.1  # m/s


class Facts(NamedTuple):
    """What of a scene is compared with others."""

    kind: str
    family: Family
    mass: float
    speed: float
    angle: float
    side: int = 0  # that goes ahead: 0 front, 1 right, 2 rear, 3 left

    @classmethod
    def of(cls, scene: Scene) -> Facts:
        """Return the facts of a scene; an angle and its supplement are the same."""
        vehicle = scene.vehicle
        acute = min(scene.impact_angle, 180.0 - scene.impact_angle)
        return cls(
            vehicle.kind or "",
            _family(scene.barrier),
            vehicle.mass,
            scene.impact_speed,
            acute,
            side_of(scene.impact_yaw),
        )


def side_of(yaw: float) -> int:
    """Return which side goes ahead at a yaw of the nose [deg], see :class:`Facts`."""
    return round(yaw / 90.0) % 4


def _family(barrier: Barrier | None) -> Family:
    """Return what kind of surface a vehicle meets."""
    if barrier is None:
        return "none"
    if barrier.has_posts:
        return "posts"
    if isinstance(barrier, Jersey):
        return "concrete"
    return "other" if isinstance(barrier, MeshBarrier) else "wall"


def same_group(one: str, other: str) -> bool:
    """Return whether two kinds of vehicles are of one group, as trucks and buses are."""
    return one == other or any({one, other} <= set(group) for group in _GROUPS)


def likeness(one: Facts, other: Facts) -> tuple[str, ...]:
    """Return in what two scenes are alike: vehicle kind, barrier, speed (10 %), angle (5 degrees).

    Angles are alike only where the same side of the vehicle goes ahead.
    """
    same = {
        "vehicle": one.kind == other.kind,
        "barrier": one.family == other.family,
        "speed": abs(other.speed - one.speed) <= _SPEED * one.speed,
        "angle": one.side == other.side and abs(other.angle - one.angle) <= _ANGLE,
    }
    return tuple(name for name, alike in same.items() if alike)


def distance(one: Facts, other: Facts) -> float:
    """Return how far two scenes are apart, as :func:`birm3d.reporting.given_tests.nearest` says."""
    kinds = 0.0
    if one.kind != other.kind:
        kinds = _OTHER_KIND if same_group(one.kind, other.kind) else _OTHER_GROUP
    families = 0.0 if one.family == other.family else _OTHER_FAMILY
    speed = abs(math.log(max(other.speed, _LEAST_SPEED) / max(one.speed, _LEAST_SPEED))) / _SPEED_SCALE
    mass = abs(math.log(other.mass / one.mass)) / _MASS_SCALE
    sides = 0.0 if one.side == other.side else _OTHER_SIDE
    return kinds + families + sides + speed + mass + abs(other.angle - one.angle) / _ANGLE_SCALE
