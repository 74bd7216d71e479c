"""The paper's case 1: a pickup that rolls at 30 mph; its tyre reactions carry its weight.

python examples/tire_reactions.py [--output FOLDER]
"""

from pathlib import Path

import birm3d
import click
import numpy as np
from birm3d import scenes, units
from matplotlib.figure import Figure


def figure(result: birm3d.Result) -> Figure:
    """Each wheel's reaction against time."""
    fig = Figure(figsize=(6.5, 3.5), layout="constrained")
    axes = fig.subplots()
    for i in range(result.tire_reaction.shape[1]):
        axes.plot(result.time, result.tire_reaction[:, i] / 1e3, label=f"wheel {i}", lw=2.5 - 0.5 * i)
    axes.set(xlabel="time [s]", ylabel="normal force [kN]", ylim=(0.0, None))
    axes.legend(frameon=False, ncols=2)
    axes.grid(alpha=0.3)
    return fig


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figure")
@click.option("--duration", default=2.0, show_default=True, help="seconds to roll")
def main(output: Path | None, duration: float) -> None:
    result = scenes.rolling(duration).run()
    vehicle = result.scene.vehicle
    weight = vehicle.mass * units.g
    mean = result.tire_reaction.mean(axis=0)

    # Statics: the axles share the weight by the lever of the mass centre between them.
    x = vehicle.wheels[:, 0]
    front, rear = x.max(), x.min()
    share = np.where(x == front, -rear, front) / (front - rear) / 2.0

    print(f"{vehicle.name}, {vehicle.mass:,.0f} kg, rolling at 30 mph for {result.time[-1]:g} s\n")
    print(f"{'wheel':8s}{'x [m]':>8s}{'y [m]':>8s}{'mean reaction [N]':>20s}{'statics [N]':>14s}")
    for i, (wheel, reaction) in enumerate(zip(vehicle.wheels, mean, strict=True)):
        print(f"{i:<8d}{wheel[0]:8.3f}{wheel[1]:8.3f}{reaction:20.3f}{share[i] * weight:14.3f}")
    print(f"{'sum':24s}{mean.sum():20.3f}{weight:14.3f}")
    unrest = np.ptp(result.tire_reaction, axis=0).max()
    bounce = np.ptp(result.position[:, 2])
    print(f"\ngreatest unrest of a reaction: {unrest:.1e} N; of the height: {bounce:.1e} m")

    if output:
        output.mkdir(parents=True, exist_ok=True)
        figure(result).savefig(output / "tire_reactions.png", dpi=150)


if __name__ == "__main__":
    main()
