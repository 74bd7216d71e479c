"""Given tests beside what this version computes of them: a page of validation that can not go stale.

Measured values come with the package: wall tests of NHTSA and published tests of barriers. What is computed
is computed when it is asked for, with the presets of the version that is asked.
"""

from __future__ import annotations

import csv
import io
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING

from .. import units
from ..assessment import Rating, rate, test_matrix
from ..barrier import Barrier
from ..signals.reference import nhtsa_tests
from ..simulation import Simulation, presets
from ..vehicle import Vehicle
from .likeness import Facts, Family, distance, likeness, side_of
from .published_class import Judgement, judged_class

if TYPE_CHECKING:
    from ..result.result import Result
    from ..scene.scene import Scene

__all__ = ["Compared", "GivenTest", "errors", "given_tests", "nearest"]

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
    published_class : str
        Class of penetration by the standard's own rule, or verdict and classes of a roadside standard; ``""``
        where none was published.
    penetration : float or None
        As it was published [m]; ``None``: it was not.
    penetration_kind : str
        ``"dynamic"``, ``"limit"`` where it was published as an upper one, ``""`` where it is not said.
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
    published_class: str = ""
    penetration: float | None = None
    penetration_kind: str = ""

    def simulation(self) -> Simulation:
        """Return the scene that stands for the test."""
        return _simulation(self.recipe)

    def rated(self, result: Result) -> Rating | None:
        """Return the rating of a run of the scene; ``None`` of a test of another quantity."""
        if self.quantity != "containment":
            return None
        return rate(result, self.standard, vehicle_class=self.vehicle_class or None)


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
        In what it is like the scene that was asked about, see :func:`birm3d.reporting.likeness.likeness`.
    rating : Rating or None
        Of the scene; ``None`` where the quantity is not containment.
    """

    test: GivenTest
    scene: Scene
    computed: float | bool
    alike: tuple[str, ...]
    rating: Rating | None = None

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

    @property
    def class_judged(self) -> Judgement | None:
        """Of containment whether class or penetration is as published; ``None`` of other quantities."""
        return None if self.rating is None else judged_class(self.test.published_class, self.rating)


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
            published_class=row["published_class"],
            penetration=float(row["penetration_m"]) if row["penetration_m"] else None,
            penetration_kind=row["penetration_kind"],
        )
        for row in csv.DictReader(lines)
    ]


@cache
def _facts(recipe: tuple[str, ...]) -> Facts:
    """Return the facts of a test; no vehicle is meshed where its test says all of them."""
    vehicle, rule, mass, barrier, _, speed, angle, yaw = recipe
    if rule == "nhtsa":
        test = nhtsa_tests()[vehicle]
        return Facts(_kind_of(presets.preset_for(test)), "wall", test.mass, test.speed, 90.0)
    if rule in ("gvw", "similar"):
        speed_si, side = units.km_h(float(speed)), side_of(float(yaw))
        return Facts(_kind_of(vehicle), _FAMILIES[barrier], float(mass), speed_si, float(angle), side)
    return Facts.of(_simulation(recipe).scene)


@cache
def _kind_of(preset: str) -> str:
    return Vehicle.preset(preset).kind or ""


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
    order = sorted(recipes, key=lambda recipe: distance(here, _facts(recipe)))[:count]
    found = []
    for recipe in order:
        simulation = _simulation(recipe)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # they are not about the run of the dossier
            result = Simulation.from_scene(simulation.scene).run()
        alike = likeness(here, Facts.of(simulation.scene))
        for test in given_tests():
            if test.recipe == recipe:
                rating = test.rated(result)
                computed = float(result.metrics[test.quantity]) if rating is None else rating.contained
                found.append(Compared(test, simulation.scene, computed, alike, rating))
    return found


def errors(compared: Sequence[Compared]) -> list[float]:
    """Return the errors of values that no number was fitted to."""
    return [one.error for one in compared if one.error is not None and not one.test.fitted]
