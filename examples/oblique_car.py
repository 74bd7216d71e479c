"""The paper's case 3: a 4,500-lb car at 59.8 mph and 24 degrees along a rigid wall.

    python examples/oblique_car.py [--output FOLDER]

Of the test itself (1975 Plymouth Fury, Texas Transportation Institute) only the conditions are published as
numbers; roll, pitch and yaw are a figure. So the load is set beside closed forms and design values, and the
friction that the paper gives as a range is varied over it. The sides of the car are estimates.
"""

from pathlib import Path

import birm3d
import click
import numpy as np
from birm3d import lateral_load, scenes, units
from birm3d.filters import moving_average
from matplotlib.figure import Figure

FRICTION = (0.15, 0.175, 0.20)


def wall_impulse(result: birm3d.Result) -> tuple[float, float]:
    """Normal impulse of the wall over m v sin a: until the car is parallel to it, and of the whole run."""
    scene = result.scene
    momentum = lateral_load.normal_momentum(scene.vehicle.mass, scene.impact_speed, scene.impact_angle)
    share = np.cumsum(result.barrier_normal_force) * scene.settings.output_interval / momentum
    parallel = int(np.argmax(np.abs(result.yaw) >= scene.impact_angle))
    return float(share[parallel]), float(share[-1])


def figure(result: birm3d.Result) -> Figure:
    """Angles and wall force against time."""
    fig = Figure(figsize=(6.5, 5.5), layout="constrained")
    angles, force = fig.subplots(2, 1, sharex=True)
    ms = result.time * 1e3
    for name, style in (("roll", "-"), ("pitch", "--"), ("yaw", "-.")):
        angles.plot(ms, getattr(result, name), style, label=name)
    angles.axhline(result.scene.impact_angle, color="0.6", lw=0.8, label="parallel to the wall")
    interval = result.scene.settings.output_interval
    normal = result.barrier_normal_force / 1e3
    force.plot(ms, normal, color="0.6", lw=0.8, label="interval means")
    force.plot(ms, moving_average(normal, 0.05, interval), color="C3", label="50-ms mean")
    force.axhline(lateral_load.TL_3_FORCE / 1e3, color="k", ls=":", label="AASHTO TL-3 design force")
    angles.set(ylabel="angle [deg]")
    force.set(xlabel="time [ms]", ylabel="normal force [kN]", xlim=(0.0, ms[-1]), ylim=(0.0, None))
    for axes in (angles, force):
        axes.legend(frameon=False, fontsize="small")
        axes.grid(alpha=0.3)
    return fig


@click.command(help=__doc__)
@click.option("--output", type=click.Path(path_type=Path), help="folder for the figures")
def main(output: Path | None) -> None:
    results = {friction: scenes.oblique_car(friction).run() for friction in FRICTION}
    result = results[0.175]
    scene, metrics = result.scene, result.metrics
    car = scene.vehicle
    outcome = "redirected" if "exit_angle" in metrics else "not redirected"
    print(f"{outcome} at {metrics['exit_speed']:.1f} m/s after {result.time[-1] * 1e3:.0f} ms")
    print(
        f"greatest roll {metrics['max_roll']:.2f}, pitch {metrics['max_pitch']:.2f}, "
        f"yaw {metrics['max_yaw']:.1f} deg; tyres carry {result.tire_reaction.min() / 1e3:.1f} kN at least:"
    )
    print("no wheel lifts, and without springs nothing else rolls the body\n")

    impact = (car.mass, scene.impact_speed, scene.impact_angle)
    size = {"front": float(car.nodes[:, 0].max()), "half_width": float(car.nodes[:, 1].max())}
    first, whole = wall_impulse(result)
    print(f"impact severity 1/2 m (v sin a)^2              {metrics['impact_severity'] / 1e3:8.1f} kJ")
    print(f"peak 50-ms mean of the wall force              {metrics['peak_force_50ms'] / 1e3:8.0f} kN")
    mean = lateral_load.olson_mean_force(*impact, **size) / 1e3
    peak = lateral_load.olson_peak_force(*impact, **size) / 1e3
    print(f"  Olson, rigid corner: mean / peak, lower bound{mean:8.0f} / {peak:.0f} kN")
    print(f"  AASHTO TL-3, design                          {lateral_load.TL_3_FORCE / 1e3:8.0f} kN")
    low, high = lateral_load.NORMAL_IMPULSE
    print(f"normal impulse / (m v sin a), until parallel   {first:8.2f}    usual {low:g} to {high:g}")
    print(f"                              with the rear's  {whole:8.2f}\n")

    titles = ("exit speed [m/s]", "exit angle [deg]", "yaw [deg]", "50 ms [kN]")
    print(f"{'friction':10s}" + "".join(f"{title:>18s}" for title in titles))
    for friction, other in results.items():
        m = other.metrics
        print(
            f"{friction:<10g}{m['exit_speed']:18.2f}{m['exit_angle']:18.2f}{m['max_yaw']:18.2f}"
            f"{m['peak_force_50ms'] / 1e3:18.1f}"
        )
    slowed = (results[0.15].metrics["exit_speed"] - results[0.20].metrics["exit_speed"]) / units.mph
    print(f"from the lowest to the highest friction: {slowed:.1f} mph of exit speed")

    if output:
        output.mkdir(parents=True, exist_ok=True)
        figure(result).savefig(output / "oblique_car.png", dpi=150)
        result.plot_plan().savefig(output / "oblique_car_plan.png", dpi=100)


if __name__ == "__main__":
    main()
