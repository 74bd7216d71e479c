"""How likely is a crush of more than 0.7 m, when mass, friction and stiffness are not known exactly?

python examples/fragility.py [--output FOLDER]
"""

from pathlib import Path

import birm3d
import click
from birm3d import Barrier, Simulation, Vehicle, units
from scipy import stats

LIMIT = 0.7  # m

# What is not known; spreads are assumed. Units are SI, see birm3d.scene_parameters for all names.
UNCERTAIN = {
    "vehicle.gvw": stats.uniform(units.lb(3500), units.lb(1000)),  # 3,500 to 4,500 lb, all equally likely
    "impact_angle": stats.truncnorm(-2.0, 2.0, 90.0, 5.0),  # deg
    "barrier.friction": stats.uniform(0.1, 0.2),
    "zone.engine.scale": stats.lognorm(0.1),
    "zone.bumper.scale": stats.lognorm(0.1),
    "zone.engine_bay.scale": stats.lognorm(0.1),  # 10 % of deviation
}


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figures")
@click.option("--runs", default=100, show_default=True, help="for each speed")
def main(output: Path | None, runs: int) -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.2)  # coarse: many runs in a short time
    simulation = Simulation(car, Barrier.rigid_wall(), units.mph(35))
    speeds = [units.mph(v) for v in (31, 33, 35, 37, 39, 41)]
    curve = birm3d.fragility(simulation, speeds, UNCERTAIN, runs, exceeds={"dynamic_crush": LIMIT})

    print(f"probability of {curve.event}, {curve.runs.sum()} runs")
    print("speed [mph]   counted          95 % interval (Wilson)")
    for speed, p, low, high in zip(curve.speeds, curve.probability, curve.low, curve.high, strict=True):
        print(f"{speed / units.mph:11.0f}{p:10.2f}{low:17.2f} to {high:.2f}")
    if curve.fit is None:
        print(f"no fitted curve: {curve.no_fit}")
    else:
        error, _ = curve.fit.standard_errors
        print(
            f"one in two at {curve.fit.median / units.mph:.1f} +- {error / units.mph:.1f} mph (lognormal fit)"
        )

    study = birm3d.sweep(simulation, impact_speed=speeds[::2], impact_angle=[30.0, 45.0, 60.0, 75.0, 90.0])
    print("\ncrush [m] at   " + "".join(f"{angle:8.0f} deg" for angle in study.grid["impact_angle"]))
    for speed in study.grid["impact_speed"]:
        crush = study["dynamic_crush"][study["impact_speed"] == speed]
        print(f"{speed / units.mph:11.0f} mph" + "".join(f"{value:12.3f}" for value in crush))

    if output:
        output.mkdir(parents=True, exist_ok=True)
        curve.plot().savefig(output / "fragility.png", dpi=100)
        figure = study.plot("impact_angle", "dynamic_crush", by="impact_speed")
        figure.savefig(output / "sweep.png", dpi=100)


if __name__ == "__main__":
    main()
