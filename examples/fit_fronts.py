"""Where the fronts of `minivan` and `pickup` come from: one number fitted to one or two tests each.

    python examples/fit_fronts.py [--output FOLDER] [--mesh-density 1]

Of these tests of NHTSA only scalars are known: mass, speed and the greatest displacement of the compartment.
So the shape of the envelope is that of the passenger car (fit_sedan_front.py), and one factor on its stresses
is fitted to that displacement. The pickup has two tests; its stresses grow with the mass of the vehicle, as
everywhere (Vehicle.scaled_to). What the structure gives back is a length, that of the passenger car.
"""

from pathlib import Path

import birm3d
import click
import numpy as np
from birm3d import scenes
from birm3d.calibration import CalibrationResult, Parameter, ScalarTarget
from birm3d.reference import nhtsa_tests
from fit_sedan_front import ZONES, front, with_envelopes
from matplotlib.figure import Figure

TESTS = {"minivan": ("7460",), "pickup": ("7360", "7582")}
SHARE = 0.03  # of the displacement: what integrating one or two accelerometers is good for


def shaped(simulation: birm3d.Simulation) -> birm3d.Simulation:
    """Give the front the passenger car's envelopes, as strong as the vehicle is heavy."""
    car = birm3d.Vehicle.preset("passenger_car", mesh_density=0.1).scaled_to(simulation.scene.vehicle.mass)
    return with_envelopes(simulation, {zone: np.array(car.zones[zone].envelope) for zone in ZONES})


def fit(name: str, mesh_density: float) -> CalibrationResult:
    tests = [nhtsa_tests()[number] for number in TESTS[name]]
    crashes = [shaped(scenes.nhtsa_frontal(test.test, mesh_density=mesh_density)) for test in tests]
    goals = []
    for test in tests:
        way = test.dynamic_displacement
        goals.append((ScalarTarget("max_displacement", way, SHARE * way),))
    scale = Parameter(front("scale"), 0.5, 3.0, log=True, name="stress / passenger car's")
    return birm3d.calibrate(crashes, goals, scale, starts=2, tolerance=1e-4)


def figure(fitted: dict[str, birm3d.Vehicle]) -> Figure:
    """Fronts per kilogram: what is left when stiffness in proportion to mass is taken out."""
    fig = Figure(figsize=(6.5, 4.0), layout="constrained")
    axes = fig.subplots()
    for name, vehicle in fitted.items():
        depth, stress = np.array(vehicle.zones[ZONES[0]].envelope).T
        axes.plot(depth, stress / vehicle.mass, label=f"{name}, {vehicle.mass:.0f} kg")
    axes.set(xlabel="deflection [m]", ylabel="stress / mass [Pa/kg]", xlim=(0.0, 0.8), ylim=(0.0, None))
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    return fig


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figure")
@click.option("--mesh-density", default=1.0, show_default=True, help="relative to the presets'")
def main(output: Path | None, mesh_density: float) -> None:
    vehicles = {"passenger_car": scenes.nhtsa_frontal("10146", mesh_density=0.1).scene.vehicle}
    for name in TESTS:
        fitted = fit(name, mesh_density)
        print(f"{name}\n{fitted.summary()}")
        print(f"\n{'test':8s}{'mass [kg]':>10s}{'measured [m]':>14s}{'in the file':>12s}{'fitted':>10s}")
        for number, crash in zip(TESTS[name], fitted.simulations, strict=True):
            test = nhtsa_tests()[number]
            before = scenes.nhtsa_frontal(number, mesh_density=mesh_density)
            ways = [run.run().metrics["max_displacement"] for run in (before, crash)]
            print(
                f"{number:8s}{test.mass:10.0f}{test.dynamic_displacement:14.3f}{ways[0]:12.3f}{ways[1]:10.3f}"
            )
        vehicles[name] = vehicle = fitted.simulations[-1].scene.vehicle
        for name_of_zone in ("bumper", "engine"):
            zone = vehicle.zones[name_of_zone]
            print(f"\n{name_of_zone} at {vehicle.mass:.0f} kg; k_unloading {zone.k_unloading:.4g} Pa/m")
            for depth, stress in zone.envelope:
                print(f"{depth:8.3f} m {1e-6 * stress:8.4f} MPa")
        print()

    if output:
        output.mkdir(parents=True, exist_ok=True)
        figure(vehicles).savefig(output / "fit_fronts.png", dpi=150)


if __name__ == "__main__":
    main()
