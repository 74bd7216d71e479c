"""Where the front of `cargo_truck` comes from: one number fitted to the pitch of a truck at a rigid wall.

    python examples/fit_truck_front.py [--output FOLDER] [--mesh-density 0.25]

Nobody has published a real truck's wall force. How strong the front is was fitted to finite-element runs of
another truck (tests/validation/fit_truck_preset.py). How high it pushes, frame and engine against grille
and hood, is fitted to the one thing that film has shown: a 15,000-lb truck at 50 mph pitches by 27 degrees.
The mass centre stands above the force, so the nose goes down and the rear wheels rise. How far depends on
more than this number: the table shows what the height of the load does.
"""

from pathlib import Path

import birm3d
import click
from birm3d import scenes
from birm3d.calibration import Parameter, ScalarTarget
from birm3d.scene_parameters import varied
from matplotlib.figure import Figure

LOW, HIGH = ("bumper", "bumper_end"), ("grille",)
PITCH = ScalarTarget("max_pitch", 27.0, 1.0)


def share_below(vehicle: birm3d.Vehicle) -> float:
    """Share of the front's force that its lower zone carries, at equal deflection."""
    low, high = (
        sum(area(vehicle, zone) * vehicle.zones[zone].envelope[1][1] for zone in zones)
        for zones in (LOW, HIGH)
    )
    return low / (low + high)


def area(vehicle: birm3d.Vehicle, zone: str) -> float:
    return float(vehicle.area[vehicle.zone_of_node == list(vehicle.zones).index(zone)].sum())


def with_share(simulation: birm3d.Simulation, share: float) -> birm3d.Simulation:
    """Move force between the zones of the front; their sum at equal deflection stays."""
    vehicle = simulation.scene.vehicle
    now = share_below(vehicle)
    factors = {LOW: share / now, HIGH: (1.0 - share) / (1.0 - now)}
    zones = {zone: vehicle.zones[zone].scaled(factor) for names, factor in factors.items() for zone in names}
    return varied(simulation, {"vehicle": vehicle.with_zones(zones)})


def figure(fitted: birm3d.Result) -> Figure:
    fig = Figure(figsize=(6.5, 4.0), layout="constrained")
    axes = fig.subplots()
    axes.plot(fitted.time, fitted.pitch)
    axes.axhline(PITCH.value, ls=":", color="0.4", label="greatest on film")
    axes.set(xlabel="time [s]", ylabel="pitch, nose down [deg]", xlim=(0.0, None))
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    return fig


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figure")
@click.option("--mesh-density", default=0.25, show_default=True, help="relative to the preset's")
def main(output: Path | None, mesh_density: float) -> None:
    crash = scenes.truck_at_wall(mesh_density=mesh_density)
    truck = crash.scene.vehicle
    start = share_below(truck)
    share = Parameter(name="share below 0.78 m", apply=with_share, lower=0.5, upper=0.99, start=start)
    fit = birm3d.calibrate(crash, PITCH, share, starts=2, tolerance=1e-4)
    print(fit.summary())
    result = fit.simulation.run()
    print(f"\nin the file: share {start:.4f}; pitch {crash.run().metrics['max_pitch']:.1f} deg")
    for name in ("max_pitch", "max_displacement", "dynamic_crush", "peak_normal_force_cfc60", "restitution"):
        print(f"{name:26s}{result.metrics[name]:12.4g}")

    print(f"\n{'goods [kg/m3]':>14s}{'mass centre [m]':>17s}{'pitch [deg]':>13s}")
    payload = truck.mass - truck.with_payload(0.0).mass
    for density in (150.0, 200.0, 300.0, 600.0):
        loaded = fit.vehicle.with_payload(payload, density=density)
        pitch = varied(crash, {"vehicle": loaded}).run().metrics["max_pitch"]
        print(f"{density:14.0f}{loaded.mass_center_height:17.3f}{pitch:13.1f}")

    if output:
        output.mkdir(parents=True, exist_ok=True)
        figure(result).savefig(output / "fit_truck_front.png", dpi=150)


if __name__ == "__main__":
    main()
