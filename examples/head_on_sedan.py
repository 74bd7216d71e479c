"""A sedan at 57 km/h into a rigid wall, beside the measured curves of NHTSA test 10146.

    python examples/head_on_sedan.py [--output FOLDER]

The shortest way from a preset to an answer that can be checked: a scene, a run, its marks, its balances, and
the measured wall force under the computed one.
"""

from pathlib import Path

import birm3d
import click
import numpy as np
from birm3d.filters import cfc
from birm3d.reference import nhtsa_10146
from matplotlib.figure import Figure


def marks_of_test(test: dict[str, np.ndarray]) -> dict[str, float]:
    """The scalars of the measured curves, under the names of `result.metrics`."""
    turned = float(np.interp(0.0, -test["velocity"][:100], test["time"][:100]))
    return {
        "peak_normal_force_cfc60": test["wall_force"].max(),
        "max_displacement": test["displacement"].max(),
        "time_of_zero_velocity": turned,
        "restitution": -test["velocity"].min() / test["velocity"][0],
    }


def figure(result: birm3d.Result, test: dict[str, np.ndarray]) -> Figure:
    """Force against time, and force against the way of the momentum centre."""
    fig = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = fig.subplots(1, 2, sharey=True)
    force = cfc(result.barrier_normal_force, 60, result.scene.settings.output_interval) / 1e3
    way = result.position[:, 0] - result.position[0, 0]
    left.plot(test["time"] * 1e3, test["wall_force"] / 1e3, "k", lw=1.0, label="NHTSA 10146")
    left.plot(result.time * 1e3, force, "C3", label="BIRM3D")
    right.plot(test["displacement"], test["wall_force"] / 1e3, "k", lw=1.0)
    right.plot(way, force, "C3")
    left.set(xlabel="time [ms]", ylabel="wall force, CFC 60 [kN]", xlim=(0.0, 130.0))
    right.set(xlabel="displacement of the momentum centre [m]", xlim=(0.0, None))
    left.legend(frameon=False)
    for axes in (left, right):
        axes.grid(alpha=0.3)
    return fig


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figures")
def main(output: Path | None) -> None:
    # birm3d/simulation/presets.py has the scene: a preset at its test mass, a rigid wall, 57.09 km/h.
    simulation = birm3d.scenes.nhtsa_10146()
    result = simulation.run()
    print(result.scene.vehicle)
    print(f"{result.time[-1] * 1e3:.0f} ms of crash took {result.run_time * 1e3:.1f} ms\n")

    test = nhtsa_10146()
    print(f"{'':26s}{'BIRM3D':>10s}{'measured':>10s}")
    for name, measured in marks_of_test(test).items():
        print(f"{name:26s}{result.metrics[name]:10.4g}{measured:10.4g}")

    # Both residuals are checks on the computation itself, not on the model.
    print(f"\nenergy residual   {result.metrics['energy_residual']:.1e} of the initial kinetic energy")
    print(f"momentum residual {result.metrics['momentum_residual']:.1e} of the greatest force")

    if output:
        output.mkdir(parents=True, exist_ok=True)
        figure(result, test).savefig(output / "head_on_sedan.png", dpi=150)
        result.plot().savefig(output / "head_on_sedan_overview.png", dpi=100)


if __name__ == "__main__":
    main()
