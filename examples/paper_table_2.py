"""The paper's Table 2: a pickup head-on into a rigid wall at 20 to 60 mph.

    python examples/paper_table_2.py [--output FOLDER]

The paper compares the peak wall force with mass times peak deceleration, which Newton makes equal for a
head-on crash; its two columns differ by 4 to 8 %. Here they are two readings of one balance.
"""

from pathlib import Path

import birm3d
import click
from birm3d import scenes, units
from matplotlib.figure import Figure

# Paper, Table 2: peak normal force of its simulation [kN].
PAPER_FORCE = {20: 1650.0, 30: 2560.0, 40: 3170.0, 50: 3360.0, 60: 3430.0}


def figure(results: dict[int, birm3d.Result]) -> Figure:
    """Deceleration against time at each speed, with the paper's peaks as dashes."""
    fig = Figure(figsize=(6.5, 4.0), layout="constrained")
    axes = fig.subplots()
    for i, (mph, result) in enumerate(results.items()):
        axes.plot(result.time * 1e3, -result.acceleration[:, 0] / units.g, color=f"C{i}", label=f"{mph} mph")
        axes.axhline(scenes.TABLE_2[mph], color=f"C{i}", ls=":", lw=1.0)
    axes.set(xlabel="time [ms]", ylabel="deceleration along r [g]", xlim=(0.0, None), ylim=(0.0, None))
    axes.legend(frameon=False, title="dotted: paper's peak")
    axes.grid(alpha=0.3)
    return fig


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figure")
def main(output: Path | None) -> None:
    results = {mph: scenes.paper_table_2(mph).run() for mph in scenes.TABLE_2}
    print(f"{'':8s}{'deceleration [g]':>18s}{'peak force [kN]':>20s}{'m a [kN]':>10s}{'force / (m a)':>22s}")
    print(
        f"{'mph':8s}{'paper':>9s}{'here':>9s}{'paper':>10s}{'here':>10s}{'here':>10s}{'paper':>10s}{'here':>12s}"
    )
    for mph, result in results.items():
        mass, metrics = result.scene.vehicle.mass, result.metrics
        paper_ma = mass * scenes.TABLE_2[mph] * units.g / 1e3
        # Along x, as the wall's normal is; along r the two part by the cosine of the pitch.
        force = float(-result.barrier_force[:, 0].min()) / 1e3
        turned = result.velocity[1:, 0] - result.velocity[:-1, 0]
        deceleration = float(-turned.min()) / result.scene.settings.output_interval
        closure = force / (mass * deceleration / 1e3)
        print(
            f"{mph:<8d}{scenes.TABLE_2[mph]:9.2f}{metrics['peak_deceleration'] / units.g:9.2f}"
            f"{PAPER_FORCE[mph]:10.0f}{force:10.0f}{mass * deceleration / 1e3:10.0f}"
            f"{PAPER_FORCE[mph] / paper_ma:10.3f}{closure:12.9f}"
        )
    worst = max(result.metrics["momentum_residual"] for result in results.values())
    print(f"\nmomentum residual, worst of all rows of all runs: {worst:.1e}")

    if output:
        output.mkdir(parents=True, exist_ok=True)
        figure(results).savefig(output / "paper_table_2.png", dpi=150)


if __name__ == "__main__":
    main()
