"""Where the front of `passenger_car` comes from: five numbers fitted to NHTSA test 10146, five chosen.

    python examples/fit_sedan_front.py [--output FOLDER] [--mesh-density 0.25]

All front zones have the same envelope of stress over depth, with four parts: the rails; the peak where the
engine meets the fire wall; what gives way behind it; the fire wall. Only the height of the peak differs.
Beside the engine its rise above the rails is SHARE of the rise before the engine. Three stresses and the two
depths at which they begin are fitted to the CFC60 wall force and to four scalars. For one body the scalars
follow from the force. They make sure that these numbers are met well, and narrow the intervals somewhat.
birm3d.calibrate says which of the five numbers one test can tell.

Five numbers are chosen: SHARE, LEAST, the engine's width, the stress behind it, and the length that the
structure gives back. The last table has restitution against speed for three lengths. One test would take
more, but then a car rebounds better at 8 m/s than at 4.
"""

import dataclasses
from pathlib import Path

import birm3d
import click
import numpy as np
from birm3d import reference, scenes
from birm3d.calibration import CurveTarget, Parameter, ScalarTarget
from birm3d.scene_parameters import varied

ZONES = ("bumper", "engine_bay", "engine")
# Measured value and what repeated tests of one car scatter: a few per cent.
SCALARS = (
    ScalarTarget("max_displacement", 0.677, 0.008),
    ScalarTarget("time_of_zero_velocity", 0.0730, 0.0015),
    ScalarTarget("restitution", 0.20, 0.02),
    ScalarTarget("peak_normal_force_cfc60", 678e3, 30e3),
)
LENGTHS = (0.075, 0.126, 0.165)  # m
SPEEDS = (2.5, 4.0, 6.0, 8.0, 10.0, 12.5, 15.9, 20.0, 25.0)  # m/s
# Least slope of unloading over the steepest of the envelopes: chosen, restitution at 2 m/s is 0.49 with it.
LEAST = 1.678
SHARE = 0.2  # of the engine's peak above the rails, beside the engine: chosen


def front(*numbers: str) -> tuple[str, ...]:
    """Names of the same numbers of all front zones."""
    return tuple(f"zone.{zone}.{number}" for zone in ZONES for number in numbers)


def envelopes(simulation: birm3d.Simulation) -> dict[str, np.ndarray]:
    vehicle = simulation.scene.vehicle
    return {zone: np.array(vehicle.zones[zone].envelope) for zone in ZONES}


def with_envelopes(simulation: birm3d.Simulation, given: dict[str, np.ndarray]) -> birm3d.Simulation:
    """Give the front envelopes; the least slope of unloading follows them. Elastic recovery and tail stay."""
    vehicle = simulation.scene.vehicle
    k_unloading = LEAST * max(slopes(envelope).max() for envelope in given.values())
    zones = {
        zone: dataclasses.replace(
            vehicle.zones[zone], envelope=tuple(map(tuple, envelope.tolist())), k_unloading=k_unloading
        )
        for zone, envelope in given.items()
    }
    return varied(simulation, {"vehicle": vehicle.with_zones(zones)})


def engine_at(simulation: birm3d.Simulation, depth: float) -> birm3d.Simulation:
    """Move the five points of the engine to a depth [m]."""
    given = envelopes(simulation)
    for envelope in given.values():
        envelope[2:7, 0] += depth - envelope[2, 0]
    return with_envelopes(simulation, given)


def engine_peak(simulation: birm3d.Simulation, stress: float) -> birm3d.Simulation:
    """Give the engine a peak [Pa], and what is beside it the peak that follows."""
    given = envelopes(simulation)
    for zone, envelope in given.items():
        rails = envelope[2, 1]
        envelope[3:5, 1] = stress if zone == "engine" else rails + SHARE * (stress - rails)
    return with_envelopes(simulation, given)


def with_recovery(simulation: birm3d.Simulation, length: float) -> birm3d.Simulation:
    """Let all zones but the tyres give back a length [m]."""
    vehicle = simulation.scene.vehicle
    zones = {
        name: dataclasses.replace(zone, elastic_recovery=length)
        for name, zone in vehicle.zones.items()
        if zone.elastic_recovery is not None
    }
    return varied(simulation, {"vehicle": vehicle.with_zones(zones)})


def slopes(envelope: np.ndarray) -> np.ndarray:
    return np.diff(envelope[:, 1]) / np.diff(envelope[:, 0])


def unknowns(car: birm3d.Vehicle) -> list[Parameter]:
    engine = np.array(car.zones["engine"].envelope)
    return [
        Parameter(front("stress[1]", "stress[2]"), 0.05e6, 0.4e6, log=True, name="rails [Pa]"),
        Parameter(
            name="engine [Pa]", apply=engine_peak, lower=0.6e6, upper=2.0e6, start=engine[3, 1], log=True
        ),
        Parameter(front("stress[6]", "stress[7]"), 0.1e6, 0.6e6, log=True, name="fire wall [Pa]"),
        Parameter(front("deflection[1]"), 0.05, 0.17, name="rails at [m]"),
        Parameter(name="engine at [m]", apply=engine_at, lower=0.18, upper=0.35, start=engine[2, 0]),
    ]


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figure")
@click.option("--mesh-density", default=0.25, show_default=True, help="relative to the preset's")
def main(output: Path | None, mesh_density: float) -> None:
    crash = scenes.nhtsa_10146(mesh_density=mesh_density)
    car = crash.scene.vehicle
    # Stress levels change before the unloading slope follows them; until then it must not be the lower one.
    steep = varied(crash, dict.fromkeys(front("k_unloading"), 1e9))
    test = reference.nhtsa_10146()
    force = CurveTarget(
        test["time"], test["wall_force"], cfc=60, filtered=True, window=(0.0, 0.13), name="wall force"
    )
    fit = birm3d.calibrate(steep, [force, *SCALARS], unknowns(car), starts=3, tolerance=1e-4)

    print(fit.summary())
    print(f"\n{'':26s}{'in the file':>12s}{'fitted':>10s}{'measured':>10s}")
    before, after = crash.run().metrics, fit.simulation.run().metrics
    for scalar in SCALARS:
        name = scalar.metric
        print(f"{name:26s}{before[name]:12.4g}{after[name]:10.4g}{scalar.value:10.4g}")
    print(f"\n{fit.comparisons()['wall force'].summary()}")

    print(f"\n{'restitution at [m/s]':22s}" + "".join(f"{speed:7.1f}" for speed in SPEEDS))
    for length in LENGTHS:
        other = with_recovery(crash, length)
        rebound = [varied(other, {"impact_speed": v}).run().metrics["restitution"] for v in SPEEDS]
        print(f"{1e3 * length:6.1f} mm given back  " + "".join(f"{value:7.3f}" for value in rebound))

    if output:
        output.mkdir(parents=True, exist_ok=True)
        fit.plot_fit().savefig(output / "fit_sedan_front.png", dpi=150)


if __name__ == "__main__":
    main()
