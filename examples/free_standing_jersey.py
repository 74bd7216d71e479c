"""A car at 100 km/h and 25 degrees along a free-standing Jersey barrier: how far does it move?

    python examples/free_standing_jersey.py [--output FOLDER]

Twelve segments of 3 m stand on the ground by their weight, pinned end to end. Friction on the ground is
varied over what concrete on asphalt may have; beside them the same segments without pins, and fixed ones. The
model lets segments slide and turn but not tip: the last column says when one would begin to.
"""

import warnings
from pathlib import Path

import birm3d
import click
from birm3d import Barrier, CoreContactWarning, FreeStanding, Simulation, TippingWarning, Vehicle, units
from birm3d.result.segment_motion import lateral_movement
from matplotlib.figure import Figure

CASES = {
    "fixed": False,
    "pinned, friction 0.4": FreeStanding(ground_friction=0.4),
    "pinned, friction 0.5": FreeStanding(ground_friction=0.5),
    "pinned, friction 0.6": FreeStanding(ground_friction=0.6),
    "loose, friction 0.5": FreeStanding(joint="loose"),
}


def figure(results: dict[str, birm3d.Result]) -> Figure:
    """Movement of the barrier against time."""
    fig = Figure(figsize=(6.5, 3.5), layout="constrained")
    axes = fig.subplots()
    for name, result in results.items():
        if name != "fixed":
            axes.plot(result.time * 1e3, lateral_movement(result), label=name)
    axes.set(xlabel="time [ms]", ylabel="deflection [m]", xlim=(0.0, None), ylim=(0.0, None))
    axes.legend(frameon=False, fontsize="small")
    axes.grid(alpha=0.3)
    return fig


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figures")
def main(output: Path | None) -> None:
    # Between loose segments the car meets an end face with its rigid core: the last column has the force.
    warnings.simplefilter("ignore", CoreContactWarning)
    warnings.simplefilter("ignore", TippingWarning)  # the table has the ratio
    car = Vehicle.preset("passenger_car", mesh_density=0.5)
    results = {
        name: Simulation(
            car, Barrier.jersey(length=36.0, segments=12, free_standing=free), units.km_h(100.0), 25.0
        ).run()
        for name, free in CASES.items()
    }
    segment = results["pinned, friction 0.5"].scene.barrier.core.segments[0]
    print(f"{car.mass:.0f} kg against segments of {segment.mass:.0f} kg\n")
    print("                        deflection [m]      50-ms force   exit speed   over-     force on the")
    print("                        greatest   stays           [kN]        [m/s]   turning   core [kN]")
    for name, result in results.items():
        metrics = result.metrics
        moved = [metrics.get(key, 0.0) for key in ("barrier_deflection", "residual_barrier_deflection")]
        leaving = f"{metrics['exit_speed']:.1f}" if "exit_speed" in metrics else "stays"
        print(
            f"{name:22s} {moved[0]:9.2f} {moved[1]:7.2f} {metrics['peak_force_50ms'] / 1e3:14.0f} "
            f"{leaving:>12s} {metrics.get('max_overturning_ratio', 0.0):9.1f} "
            f"{metrics['core_contact_force'] / 1e3:11.0f}"
        )
    print("\nabove an overturning ratio of 1 a segment would begin to tip, which the model leaves out")

    if output:
        output.mkdir(parents=True, exist_ok=True)
        figure(results).savefig(output / "free_standing_jersey.png", dpi=150)
        plan = results["pinned, friction 0.5"].plot_plan()
        plan.savefig(output / "free_standing_jersey_plan.png", dpi=150)


if __name__ == "__main__":
    main()
