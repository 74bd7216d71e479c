"""Why the truss force is projected on the wall's normal: the energy of oblique impacts under both rules.

    python examples/contact_models.py [--output FOLDER]

A node at the wall is free to slide along it. The paper lets its truss push the vehicle along the truss
(`along_truss`), which does work along the wall that the truss never took; projected on the normal
(`projected`, the default) the force does exactly the work that crushes. Without friction the total energy of
the run must stay as it was: what is left over is made or lost by the rule alone.
"""

import warnings
from pathlib import Path

import birm3d
import click
import numpy as np
from birm3d import Settings, scenes
from matplotlib.figure import Figure

ANGLES = (10.0, 24.0, 45.0, 66.0)  # deg
MODELS = ("projected", "along_truss")


def figure(results: dict[tuple[str, float], birm3d.Result]) -> Figure:
    """Energy left over against time, for each angle and rule."""
    fig = Figure(figsize=(6.5, 4.0), layout="constrained")
    axes = fig.subplots()
    for (model, angle), result in results.items():
        color = f"C{ANGLES.index(angle)}"
        share = 100.0 * result.energy["residual"] / result.energy["total"][0]
        style = "-" if model == "projected" else "--"
        axes.plot(result.time * 1e3, share, style, color=color, label=f"{angle:g}° {model}")
    axes.set(xlabel="time [ms]", ylabel="energy imbalance [% of the initial energy]")
    axes.legend(frameon=False, ncols=2, fontsize="small")
    axes.grid(alpha=0.3)
    return fig


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figure")
def main(output: Path | None) -> None:
    # That the paper's rule makes energy is what is shown here.
    warnings.filterwarnings("ignore", "energy_residual.*along_truss", birm3d.BalanceWarning)
    results = {
        (model, angle): scenes.oblique(angle, settings=Settings(contact_model=model, tolerance=1e-4)).run()
        for angle in ANGLES
        for model in MODELS
    }
    print(
        "passenger car, 59.8 mph, frictionless wall; energy made (+) or lost (-), % of the initial energy\n"
    )
    print(
        f"{'angle [deg]':12s}"
        + "".join(f"{model:>16s}" for model in MODELS)
        + f"{'speed at the end [m/s]':>24s}"
    )
    for angle in ANGLES:
        line = f"{angle:<12g}"
        for model in MODELS:
            energy = results[model, angle].energy
            line += f"{100.0 * energy['residual'][-1] / energy['total'][0]:+16.4f}"
        speeds = " / ".join(f"{np.linalg.norm(results[model, angle].velocity[-1]):.2f}" for model in MODELS)
        print(f"{line}{speeds:>24s}")

    if output:
        output.mkdir(parents=True, exist_ok=True)
        figure(results).savefig(output / "contact_models.png", dpi=150)


if __name__ == "__main__":
    main()
