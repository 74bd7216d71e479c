"""Given tests beside what this version computes of them: a page of validation that can not go stale.

Measured values come with the package: wall tests of NHTSA and published tests of barriers. What is computed
is computed when it is asked for, with the presets of the version that is asked.
"""

# Longer than 300 lines: one page, with a function for each of its parts.
from __future__ import annotations

import csv
import io
import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from .. import units
from ..assessment import rate, test_matrix
from ..barrier import Barrier
from ..barrier.kinds import Jersey, MeshBarrier
from ..signals.reference import nhtsa_tests
from ..simulation import Simulation, presets
from ..vehicle import Vehicle

if TYPE_CHECKING:
    from ..result.result import Result
    from ..scene.scene import Scene

__all__ = ["Compared", "Facts", "GivenTest", "errors", "given_tests", "likeness", "nearest"]

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
_NOTHING_MORE = ("",) * 6  # a recipe whose vehicle says all has no other entries
_FAMILIES: dict[str, Family] = {
    "bollards": "posts",
    "pole": "posts",
    "jersey": "concrete",
    "rigid_wall": "wall",
}


@dataclass(frozen=True)
class GivenTest:
    """A test with one measured value; :meth:`simulation` is the scene that stands for it.

    Attributes
    ----------
    name, source : str
    quantity : str
        ``"containment"``, or a metric of a run.
    measured : float or bool
        SI and degrees; of containment whether the vehicle was contained.
    unit : str
    fitted : bool
        Whether a number of the preset was fitted to this test; then it shows what the model can describe,
        not what it predicts.
    note, standard, vehicle_class, published : str
        Of tests of barriers: what was not published, and what the test was rated as.
    recipe : tuple of str
        Vehicle, mass rule, mass [kg], barrier, sizes, speed [km/h], angle [deg], yaw of the nose [deg].
    """

    name: str
    source: str
    quantity: str
    measured: float | bool
    unit: str
    fitted: bool
    recipe: tuple[str, ...]
    note: str = ""
    standard: str = ""
    vehicle_class: str = ""
    published: str = ""

    def simulation(self) -> Simulation:
        """Return the scene that stands for the test."""
        return _simulation(self.recipe)

    def computed(self, result: Result) -> float | bool:
        """Return what a run of the scene says of the quantity."""
        if self.quantity == "containment":
            return rate(result, self.standard, vehicle_class=self.vehicle_class or None).contained
        return float(result.metrics[self.quantity])


@dataclass(frozen=True)
class Compared:
    """A given test beside what this version computes of it.

    Attributes
    ----------
    test : GivenTest
    scene : Scene
        That stands for the test.
    computed : float or bool
    alike : tuple of str
        In what it is like the scene that was asked about, see :func:`likeness`.
    """

    test: GivenTest
    scene: Scene
    computed: float | bool
    alike: tuple[str, ...]

    @property
    def error(self) -> float | None:
        """Relative to the measured value; ``None`` of containment."""
        if isinstance(self.test.measured, bool):
            return None
        return self.computed / self.test.measured - 1.0

    @property
    def right(self) -> bool | None:
        """Of containment whether computed is as measured."""
        return self.computed == self.test.measured if isinstance(self.test.measured, bool) else None


@cache
def given_tests() -> tuple[GivenTest, ...]:
    """Return all tests that come with the package and have a scene."""
    return (*_sedan(), *_frontal(), *_published())


@cache
def _simulation(recipe: tuple[str, ...]) -> Simulation:
    vehicle, rule, mass, barrier, sizes, speed, angle, yaw = recipe
    if rule == "nhtsa":
        return presets.nhtsa_frontal(vehicle)
    if rule == "scene":
        made: Simulation = getattr(presets, vehicle)()
        return made
    given = {key: float(value) for key, value in (size.split("=") for size in sizes.split())}
    if "count" in given:
        given["count"] = int(given["count"])
    stands = getattr(Barrier, barrier)(**given)
    if rule == "matrix":
        return test_matrix(vehicle, barrier=stands)[0]
    preset = Vehicle.preset(vehicle)
    loaded = preset.with_gvw(float(mass)) if rule == "gvw" else preset.scaled_to(float(mass))
    return Simulation(loaded, stands, units.km_h(float(speed)), float(angle), impact_yaw=float(yaw))


def _sedan() -> list[GivenTest]:
    """Return what was measured in the one wall test with load cells; the sedan's front is fitted to it."""
    recipe = ("nhtsa_10146", "scene", *_NOTHING_MORE)
    source = "NHTSA vehicle crash test database, test 10146, 176 load cells"
    values = (
        ("peak_normal_force_cfc60", 678e3, "N"),
        ("max_displacement", 0.677, "m"),
        ("restitution", 0.20, ""),
    )
    return [
        GivenTest("NHTSA 10146, Toyota Camry 2018", source, quantity, value, unit, True, recipe)
        for quantity, value, unit in values
    ]


def _frontal() -> list[GivenTest]:
    return [
        GivenTest(
            name=f"NHTSA {test.test}, {test.make.title()} {test.model.title()} {test.year}",
            source=f"NHTSA vehicle crash test database, test {test.test}, compartment's displacement",
            quantity="max_displacement",
            measured=test.dynamic_displacement,
            unit="m",
            fitted=test.split == "CALIBRATE",
            recipe=(test.test, "nhtsa", *_NOTHING_MORE),
        )
        for test in nhtsa_tests().values()
        if test.kind == "frontal"
        and test.quality in ("A", "B")
        and test.dynamic_displacement is not None
        and test.test != "10146"  # its own momentum centre is known, see _sedan()
    ]


def _published() -> list[GivenTest]:
    text = (resources.files("birm3d") / "data" / "published_tests.csv").read_text(encoding="utf-8")
    lines = (line for line in io.StringIO(text) if not line.startswith("#"))
    recipe = ("vehicle", "mass_rule", "mass_kg", "barrier", "sizes", "speed_km_h", "angle_deg", "yaw_deg")
    return [
        GivenTest(
            name=row["name"],
            source=row["source"],
            quantity=row["quantity"],
            measured=row["measured"] == "yes" if row["quantity"] == "containment" else float(row["measured"]),
            unit=row["unit"],
            fitted=row["fitted"] == "yes",
            recipe=tuple(row[key] for key in recipe),
            note=row["note"],
            standard=row["standard"],
            vehicle_class=row["vehicle_class"],
            published=row["published"],
        )
        for row in csv.DictReader(lines)
    ]


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
            family(scene.barrier),
            vehicle.mass,
            scene.impact_speed,
            acute,
            _side(scene.impact_yaw),
        )


def _side(yaw: float) -> int:
    return round(yaw / 90.0) % 4


def family(barrier: Barrier | None) -> Family:
    """Return what kind of surface a vehicle meets."""
    if barrier is None:
        return "none"
    if barrier.has_posts:
        return "posts"
    if isinstance(barrier, Jersey):
        return "concrete"
    return "other" if isinstance(barrier, MeshBarrier) else "wall"


@cache
def _facts(recipe: tuple[str, ...]) -> Facts:
    """Return the facts of a test; no vehicle is meshed where its test says all of them."""
    vehicle, rule, mass, barrier, _, speed, angle, yaw = recipe
    if rule == "nhtsa":
        test = nhtsa_tests()[vehicle]
        return Facts(_kind_of(presets.preset_for(test)), "wall", test.mass, test.speed, 90.0)
    if rule in ("gvw", "similar"):
        speed_si, side = units.km_h(float(speed)), _side(float(yaw))
        return Facts(_kind_of(vehicle), _FAMILIES[barrier], float(mass), speed_si, float(angle), side)
    return Facts.of(_simulation(recipe).scene)


@cache
def _kind_of(preset: str) -> str:
    return Vehicle.preset(preset).kind or ""


def _group(kind: str) -> tuple[str, ...]:
    return next((group for group in _GROUPS if kind in group), (kind,))


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


def _distance(one: Facts, other: Facts) -> float:
    kinds = 0.0
    if one.kind != other.kind:
        kinds = _OTHER_KIND if _group(one.kind) == _group(other.kind) else _OTHER_GROUP
    families = 0.0 if one.family == other.family else _OTHER_FAMILY
    speed = abs(math.log(max(other.speed, _LEAST_SPEED) / max(one.speed, _LEAST_SPEED))) / _SPEED_SCALE
    mass = abs(math.log(other.mass / one.mass)) / _MASS_SCALE
    sides = 0.0 if one.side == other.side else _OTHER_SIDE
    return kinds + families + sides + speed + mass + abs(other.angle - one.angle) / _ANGLE_SCALE


def nearest(scene: Scene, count: int = 10) -> list[Compared]:
    """Return the given tests nearest to a scene, computed anew, the nearest first.

    Distance: 1 for another kind of barrier (wall, posts, concrete profile), 1 for another group of vehicles
    (0.3 within a group), 1 for another side of the vehicle ahead. Numbers add the logarithm of the ratio of
    speeds over 0.4, that of masses over 0.8, and the angle over 30 degrees. Values of one test count as one.

    Parameters
    ----------
    scene
        That is asked about.
    count
        Greatest number of tests, >= 1.
    """
    here = Facts.of(scene)
    recipes = dict.fromkeys(test.recipe for test in given_tests())
    order = sorted(recipes, key=lambda recipe: _distance(here, _facts(recipe)))[:count]
    found = []
    for recipe in order:
        simulation = _simulation(recipe)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # they are not about the run of the dossier
            result = Simulation.from_scene(simulation.scene).run()
        there = Facts.of(simulation.scene)
        found += [
            Compared(test, simulation.scene, test.computed(result), likeness(here, there))
            for test in given_tests()
            if test.recipe == recipe
        ]
    return found


def errors(compared: Sequence[Compared]) -> list[float]:
    """Return the errors of values that no number was fitted to."""
    return [one.error for one in compared if one.error is not None and not one.test.fitted]
