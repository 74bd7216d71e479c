"""Vehicles of your own: from arrays, from a preset with another zone, at another weight.

python examples/own_vehicle.py [--output FOLDER]
"""

from pathlib import Path

import click
import numpy as np
from birm3d import Barrier, Simulation, Vehicle, units


def trolley() -> Vehicle:
    """Return a barrier test trolley of 900 kg: a rigid frame behind a crushable nose of 20 by 10 trusses."""
    y, z = np.meshgrid(np.linspace(-0.8, 0.8, 20), np.linspace(-0.2, 0.2, 10))
    nodes = np.column_stack([np.full(y.size, 1.6), y.ravel(), z.ravel()])
    return Vehicle.from_arrays(
        name="trolley",
        mass=900.0,
        inertia=np.diag([200.0, 900.0, 1000.0]),
        nodes=nodes,  # body axes: forward, left, up from the mass centre
        anchors=nodes - [0.9, 0.0, 0.0],  # each truss may shorten by up to 0.9 m
        k_initial=1.5e6 / len(nodes),  # N/m of each truss: 1.5 MN/m of the nose
        knee=0.1,
        k_hardening=0.3e6 / len(nodes),
        k_unloading=10e6 / len(nodes),
        mass_center_height=0.5,
        wheels=[(x, side, -0.2, 0.3) for x in (1.0, -1.0) for side in (0.7, -0.7)],
    )


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figure")
def main(output: Path | None) -> None:
    car = Vehicle.preset("passenger_car")
    # Vehicles are immutable: each of these is a new one.
    loaded = car.with_gvw(1.25 * car.mass)
    bumper = car.zones["bumper"]
    if bumper.envelope is not None:
        softer = car.with_zone("bumper", envelope=[(d, 0.7 * stress) for d, stress in bumper.envelope])
    else:
        softer = car.with_zone("bumper", k_initial=0.7 * bumper["k_initial"])
    fleet = {"trolley": trolley(), "car": car, "car, 25 % heavier": loaded, "car, bumper 30 % softer": softer}

    print(f"{'':26s}{'mass [kg]':>10s}{'crush [m]':>11s}{'peak force [kN]':>17s}{'rebound [m/s]':>15s}")
    results = {}
    for name, vehicle in fleet.items():
        results[name] = Simulation(vehicle, Barrier.rigid_wall(), units.km_h(50)).run()
        metrics = results[name].metrics
        print(
            f"{name:26s}{vehicle.mass:10.0f}{metrics['dynamic_crush']:11.3f}"
            f"{metrics['peak_normal_force'] / 1e3:17.0f}{metrics['exit_speed']:15.2f}"
        )

    if output:
        output.mkdir(parents=True, exist_ok=True)
        results["trolley"].plot().savefig(output / "own_vehicle.png", dpi=100)


if __name__ == "__main__":
    main()
