"""The paper's case 4: a 15,000-lb truck at 50 mph, head-on into a rigid wall and into bollards.

    python examples/truck_on_wall_and_bollards.py [--output FOLDER] [--mesh-density 1.0]

Film of the tests showed a greatest pitch of 27 deg at the wall and 23 at the bollards; the paper computed 25
and 22. The front of our truck is fitted to the wall (fit_truck_front.py). The bollards are a prediction: no
number was touched for them. The sizes of the tested array were not found published, so a row is assumed and
varied.
"""

from pathlib import Path

import birm3d
import click
from birm3d import scenes
from matplotlib.figure import Figure

MEASURED = {"wall": 27.0, "bollards": 23.0}  # deg, film
PAPER = {"wall": 25.0, "bollards": 22.0}  # deg, its simulation
# What the tested row may have been [m]; the first is the assumed one.
VARIANTS: tuple[dict[str, float], ...] = (
    {},
    {"height": 0.75},
    {"height": 1.25},
    {"height": 1.5},
    {"diameter": 0.2},
    {"diameter": 0.4},
    {"diameter": 0.6},
    {"spacing": 0.8},
    {"spacing": 1.5},
    {"offset": 0.6},
)


def figure(results: dict[str, birm3d.Result]) -> Figure:
    """Pitch against time, with what film showed as dashes."""
    fig = Figure(figsize=(6.5, 4.0), layout="constrained")
    axes = fig.subplots()
    for i, (name, result) in enumerate(results.items()):
        axes.plot(result.time, result.pitch, color=f"C{i}", label=name)
        axes.axhline(MEASURED[name], color=f"C{i}", ls=":", label=f"{name}, film: greatest")
    axes.set(xlabel="time [s]", ylabel="pitch, nose down [deg]", xlim=(0.0, None))
    axes.legend(frameon=False, fontsize="small")
    axes.grid(alpha=0.3)
    return fig


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figure")
@click.option("--mesh-density", default=1.0, show_default=True, help="relative to the preset's")
def main(output: Path | None, mesh_density: float) -> None:

    rows = [
        (changes, scenes.truck_at_bollards(mesh_density=mesh_density, **changes).run())
        for changes in VARIANTS
    ]
    results = {"wall": scenes.truck_at_wall(mesh_density=mesh_density).run(), "bollards": rows[0][1]}
    print(f"{'greatest pitch [deg]':22s}{'film':>8s}{'paper':>8s}{'here':>8s}{'here - film':>13s}")
    for name, result in results.items():
        pitch = result.metrics["max_pitch"]
        kind = "fitted" if name == "wall" else "predicted"
        print(
            f"{name + ', ' + kind:22s}{MEASURED[name]:8.0f}{PAPER[name]:8.0f}{pitch:8.1f}"
            f"{pitch - MEASURED[name]:+13.1f}"
        )
    more = results["bollards"].metrics["max_pitch"] > results["wall"].metrics["max_pitch"]
    print(
        f"film shows less pitch at the bollards than at the wall; here it is {'more' if more else 'less'}\n"
    )

    print("five bollards; assumed: diameter 0.32, height 1.0, spacing 1.2 (centre to centre), offset 0 m")
    titles = ("pitch [deg]", "travel [m]", "load height [m]", "energy residual")
    print(f"{'changed to [m]':18s}" + "".join(f"{title:>17s}" for title in titles))
    for changes, result in rows:
        what = ", ".join(f"{name} {value:g}" for name, value in changes.items()) or "as assumed"
        load = max(result.element_loads, key=lambda load: load.peak_force_50ms)
        metrics = result.metrics
        print(
            f"{what:18s}{metrics['max_pitch']:17.1f}{metrics['max_displacement']:17.2f}"
            f"{load.height_at_peak:17.2f}{metrics['energy_residual']:17.1e}"
        )
    print(
        f"mass centre of the truck: {results['wall'].scene.vehicle.mass_center_height:.2f} m above the ground"
    )

    if output:
        output.mkdir(parents=True, exist_ok=True)
        figure(results).savefig(output / "truck_on_wall_and_bollards.png", dpi=150)


if __name__ == "__main__":
    main()
