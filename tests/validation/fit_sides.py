"""The sides of the presets, from NHTSA's oblique pole tests: one factor on their stresses.

    python tests/validation/fit_sides.py [--mesh-density 0.25] [--predict]

The vehicle goes at 8.9 m/s into a rigid pole of 254 mm that stands beside the driver's head; its axis makes
75 deg with the path. Of these tests only the greatest static crush is known, to be met by the residual crush,
and the tyres' friction is left out: the vehicle stands on a carrier. The shape of the envelope and the
unloading slope stay; one factor is fitted to the rows marked CALIBRATE, of the pickup to its two rows
together. The files have what was found so: a factor of 1 is left to find. With --predict the rows marked
EXTRA are computed too, at the mass of each.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Sequence

import birm3d
import numpy as np
from birm3d import scenes
from birm3d.calibration import CalibrationResult, Parameter, ScalarTarget
from birm3d.reference import NhtsaTest, nhtsa_tests

POLE = 0.254  # m
HEADING = -75.0  # deg, of the nose from the path: the left side goes ahead
# Driver's head behind the front axle and left of the middle, m: estimates from usual seating.
HEAD = {"passenger_car": (1.45, 0.37), "minivan": (1.35, 0.40), "pickup": (1.60, 0.42)}
# Not the fenders: they stand beside the front, which was fitted with them as they are.
SIDES = {
    "passenger_car": ("door", "quarter"),
    "minivan": ("door", "quarter"),
    "pickup": ("door", "box"),
}
SIGMA = 0.05  # m: what crush of one kind of vehicle scatters by


def scene(test: NhtsaTest, mesh_density: float) -> birm3d.Simulation:
    name = scenes.preset_for(test)
    vehicle = birm3d.Vehicle.preset(name, mesh_density=mesh_density).scaled_to(test.mass)
    behind, left = HEAD[name]
    head = np.array([-behind - vehicle.center_of_mass[0], left])
    angle = np.radians(HEADING)
    across = np.sin(angle) * head[0] + np.cos(angle) * head[1]
    return birm3d.Simulation(
        vehicle,
        birm3d.Barrier.pole(diameter=POLE),
        test.speed,
        impact_offset=float(-across),
        impact_yaw=HEADING,
        settings=birm3d.Settings(mu_tire=0.0),
    )


def rows(split: str) -> list[NhtsaTest]:
    return [
        test
        for test in nhtsa_tests().values()
        if test.kind == "side_pole" and test.split == split and test.vehicle_class != "full_size_van"
    ]


def fit(name: str, options: argparse.Namespace) -> tuple[CalibrationResult, list[NhtsaTest]]:
    tests = [test for test in rows("CALIBRATE") if scenes.preset_for(test) == name]
    goals = []
    for test in tests:
        assert test.static_crush is not None  # the table has it of every pole test
        goals.append((ScalarTarget("residual_crush", test.static_crush, SIGMA),))
    scale = Parameter(
        tuple(f"zone.{zone}.scale" for zone in SIDES[name]), 0.1, 20.0, log=True, name="stress / the file's"
    )
    crashes = [scene(test, options.mesh_density) for test in tests]
    return birm3d.calibrate(crashes, goals, scale, starts=2, tolerance=1e-4), tests


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mesh-density", type=float, default=1.0, help="relative to the presets'")
    parser.add_argument("--predict", action="store_true", help="also the rows marked EXTRA")
    options = parser.parse_args(arguments)
    head = f"{'test':6s}{'class':26s}{'mass':>7s}{'measured':>10s}{'in the file':>13s}{'fitted':>9s}"
    for name in HEAD:
        found, tests = fit(name, options)
        print(f"{name}\n{found.summary()}\n\n{head}")
        for test, crash in zip(tests, found.simulations, strict=True):
            told = f"{test.test:6s}{test.vehicle_class:26s}{test.mass:7.0f}{test.static_crush:10.3f}"
            before = scene(test, options.mesh_density).run().metrics["residual_crush"]
            print(f"{told}{before:13.3f}{crash.run().metrics['residual_crush']:9.3f}")
        print()
    if options.predict:
        errors = []
        for test in rows("EXTRA"):
            assert test.static_crush is not None
            crush = scene(test, options.mesh_density).run().metrics["residual_crush"]
            errors.append(abs(crush / test.static_crush - 1.0))
            told = f"{test.test:6s}{test.vehicle_class:26s}{test.mass:7.0f}{test.static_crush:10.3f}"
            print(f"{told}{crush:13.3f}{100 * (crush / test.static_crush - 1):+9.1f}%")
        print(f"with the file's zones, median of |error| of {len(errors)}: {statistics.median(errors):.1%}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
