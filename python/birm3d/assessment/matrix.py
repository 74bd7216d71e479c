"""Simulations of the tests that a standard asks for."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from .. import units
from ..barrier import Barrier
from ..base.arguments import checked
from ..scene.settings import Settings
from ..simulation import Simulation
from ..units import Quantity
from ..vehicle import Vehicle
from ..vehicle.payload import structure_mass
from .rate import split_standard
from .roadside import EN_1317, MASH, RoadsideStandard
from .security import SECURITY, SecurityStandard
from .vehicles import StandardVehicle

__all__ = ["Matrix", "test_matrix"]

_ALONE = 1.0  # duration of a run without barrier [s]
_ANGLE = 90.0  # deg; of a test of a security barrier
_CODE = re.compile(r"V/(?P<mass>\d+)\[(?P<code>\w+)\]/(?P<speed>\d+)/(?P<angle>\d+)(:.*)?")
_LEVEL = re.compile(r"(?P<code>[A-Z]+7?)(?P<speed>[3456]0)(-P\d)?")
_K_MPH = {"K4": 30.0, "K8": 40.0, "K12": 50.0}

# What the standards call a vehicle -> presets that can be brought to its mass, the best one first.
_PRESETS: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(("1100C", "SC", "C"), ("mash_1100c", "small_car", "passenger_car")),
    **dict.fromkeys(("2270P", "PU", "P"), ("mash_2270p", "pickup")),
    **dict.fromkeys(("10000S", "10-t rigid HGV"), ("mash_10000s", "cargo_truck")),
    **dict.fromkeys(("36000V", "36000T", "38-t articulated HGV"), ("mash_36000v", "semi_truck")),
    "900-kg car": ("small_car", "passenger_car"),
    **dict.fromkeys(("1,300-kg car", "1,500-kg car", "M1"), ("sedan_1500", "passenger_car")),
    "13-t bus": ("bus_13t",),
    **dict.fromkeys(("16-t rigid HGV", "30-t rigid HGV", "H", "N3G"), ("heavy_truck_29500",)),
    "FS": ("passenger_car",),
    **dict.fromkeys(("M", "15,000-lb truck"), ("cargo_truck",)),
    **dict.fromkeys(("C7", "N3C", "N2A", "N2B"), ("cabover_7200", "cabover_7500")),
    **dict.fromkeys(("N2", "N3"), ("cabover_7500", "cabover_7200")),
    "N1G": ("pickup_4x4_2500", "pickup"),
    "N1": ("van_3500",),
}
_BALLAST = {"10000S": 1.60, "36000V": 1.85, "36000T": 1.85}
"""Height of the middle of the ballast above the ground that MASH asks for, 63 in and 73 in [m]."""
_LOADED = ("truck", "cab_over_truck", "bus", "tractor_semitrailer")
"""Kinds that are brought to a mass by their load; others are scaled as vehicles of their class."""


class _Test(NamedTuple):
    name: str
    vehicle: StandardVehicle
    speed: float  # m/s
    angle: float  # deg


class Matrix(list[Simulation]):
    """Simulations of the tests of a standard, in its order.

    Attributes
    ----------
    names : tuple of str
        Of the tests, as ``"3-11"``.
    """

    def __init__(self, simulations: Iterable[Simulation], names: tuple[str, ...]) -> None:
        super().__init__(simulations)
        self.names = names


@checked
def test_matrix(
    standard: str,
    *,
    barrier: Barrier | None = None,
    vehicles: Mapping[str, Vehicle] | None = None,
    impact_offset: Quantity = 0.0,
    mesh_density: float = 1.0,
    duration: Quantity | None = None,
    settings: Settings | None = None,
) -> Matrix:
    """Return the simulations of the tests that a standard asks for, at nominal mass, speed and angle.

    Parameters
    ----------
    standard
        Standard with a level or a test: ``"MASH TL-3"``, ``"MASH 3-11"``, ``"EN 1317 N2"``,
        ``"EN 1317 TB32"``, ``"ASTM F2656 M50"``, ``"SD-STD-02.01 K12"``, ``"IWA 14-1 V/7200[N3C]/80/90"``.
    barrier
        ``None``: the vehicles run on their own, for 1 s where `duration` is ``None``.
    vehicles
        What the standard calls a vehicle, as ``"2270P"`` -> vehicle to take for it. Others are presets,
        brought to the nominal mass: cars, vans and pickups as similar vehicles
        (:meth:`birm3d.Vehicle.scaled_to`), trucks and buses by their load (:meth:`birm3d.Vehicle.with_gvw`).
        The middle of the load of MASH's trucks is as high as MASH asks for. The package has no tank trailer:
        the 36000T of test 6-12 is the van trailer of the 36000V.
    impact_offset, duration, settings
        See :class:`birm3d.Simulation`.
    mesh_density
        Of the presets.

    Raises
    ------
    ValueError
        If there is no such standard, level or test, or the package has no vehicle for it.
    """
    name, rest = split_standard(standard)
    tests = _tests(name, rest, standard)
    given = dict(vehicles or {})
    wanted = {test.vehicle.code for test in tests}
    for code in given:
        if code not in wanted:
            raise ValueError(f"vehicles must name vehicles of {standard}: {', '.join(wanted)}; got {code!r}")
    if barrier is None and duration is None:
        duration = _ALONE
    made: dict[str, Vehicle] = {}
    for test in tests:
        if test.vehicle.code not in made:
            own = given.get(test.vehicle.code)
            made[test.vehicle.code] = own if own is not None else _vehicle(test.vehicle, mesh_density)
    runs = [
        Simulation(
            made[test.vehicle.code],
            barrier,
            test.speed,
            test.angle,
            impact_offset,
            duration=duration,
            settings=settings,
        )
        for test in tests
    ]
    return Matrix(runs, tuple(test.name for test in tests))


test_matrix.__test__ = False  # type: ignore[attr-defined]  # its name is no reason for pytest to run it


def _tests(name: str, rest: str | None, standard: str) -> list[_Test]:
    roadside = {one.name: one for one in (MASH, EN_1317)}
    if name in roadside:
        return _roadside(roadside[name], rest, standard)
    reader: Callable[[SecurityStandard, str, str], _Test]
    reader = {"levels": _astm, "K": _dos, "code": _coded}[SECURITY[name].style]
    return [reader(SECURITY[name], rest or "", standard)]


def _roadside(rules: RoadsideStandard, rest: str | None, standard: str) -> list[_Test]:
    if rest is None or (rest not in rules.levels and rest not in rules.tests):
        raise ValueError(
            f"standard must name a level ({', '.join(rules.levels)}) or a test ({', '.join(rules.tests)}) of "
            f"{rules.name}, got {standard!r}"
        )
    names = rules.levels.get(rest, (rest,))
    tests = (rules.tests[name] for name in names)
    return [_Test(test.name, test.vehicle, units.km_h(test.speed), test.angle) for test in tests]


def _astm(rules: SecurityStandard, rest: str, standard: str) -> _Test:
    found = _LEVEL.fullmatch(rest)
    known = {one.code: one for one in rules.vehicles}
    light = found is not None and found["code"] not in ("M", "C7", "H")
    if found is None or found["code"] not in known or (found["speed"] == "60" and not light):
        raise ValueError(
            f"standard must name one of {', '.join(known)} with 30, 40 or 50 (60 for cars and pickups), as "
            f"'{rules.name} M50'; got {standard!r}"
        )
    return _Test(rest, known[found["code"]], units.mph(float(found["speed"])), _ANGLE)


def _dos(rules: SecurityStandard, rest: str, standard: str) -> _Test:
    level = rest.partition("-")[0]
    if level not in _K_MPH:
        raise ValueError(
            f"standard must name one of {', '.join(_K_MPH)}, as '{rules.name} K12'; got {standard!r}"
        )
    return _Test(rest, rules.vehicles[0], units.mph(_K_MPH[level]), _ANGLE)


def _coded(rules: SecurityStandard, rest: str, standard: str) -> _Test:
    found = _CODE.fullmatch(rest)
    if found is not None:
        for one in rules.vehicles:
            if (one.code, f"{one.mass:.0f}") == (found["code"], found["mass"]):
                return _Test(rest, one, units.km_h(float(found["speed"])), float(found["angle"]))
    known = ", ".join(f"V/{one.mass:.0f}[{one.code}]" for one in rules.vehicles)
    raise ValueError(
        f"standard must have a code such as '{rules.name} V/1500[M1]/48/90', with one of {known}; "
        f"got {standard!r}"
    )


def _vehicle(wanted: StandardVehicle, mesh_density: float) -> Vehicle:
    """Return a preset at the nominal mass of a standard's vehicle."""
    names = _PRESETS[wanted.code]
    preset = next((name for name in names if name in Vehicle.presets()), None)
    if preset is None:
        raise ValueError(
            f"vehicles must give {wanted.words}: the package has no preset of its kind, got none"
        )
    vehicle = Vehicle.preset(preset, mesh_density=mesh_density)
    if wanted.code in _BALLAST:
        return ballasted(vehicle, wanted.mass, _BALLAST[wanted.code])
    if vehicle.mass == wanted.mass:
        return vehicle
    if vehicle.kind not in _LOADED:
        return vehicle.scaled_to(wanted.mass)
    return vehicle.with_gvw(wanted.mass)


def ballasted(vehicle: Vehicle, mass: float, height: float) -> Vehicle:
    """Return a truck with so much load in its load space that it has a mass, its middle at a height.

    Parameters
    ----------
    mass
        Of the whole [kg].
    height
        Of the middle of the load above the ground [m].

    Raises
    ------
    ValueError
        If the vehicle has no load space, or the load does not fit.
    """
    carrier = vehicle.units[-1]
    file = carrier._file
    floors = [] if file is None else [one.box_m[2][0] for one in file.solids if one.fills_to_m and one.box_m]
    if file is None or not floors:
        raise ValueError(f"vehicle must have a load space to be ballasted, got {vehicle.name!r}")
    payload = mass - (vehicle.mass - carrier.mass) - structure_mass(file)
    return vehicle.with_payload(payload, height=2.0 * (height - floors[0]))
