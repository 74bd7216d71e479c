"""Where the front of `passenger_car` comes from: six numbers fitted to NHTSA test 10146.

    python examples/fit_sedan_front.py [--output FOLDER]

The front zones share one envelope: rails, the engine meeting the fire wall, what is left behind them. Its
three stress levels, the two depths at which they begin and the unloading slope are fitted by least squares to
the CFC60 wall force and to four scalars, from the numbers in the vehicle file and two points around them.
"""

import argparse
from pathlib import Path

import birm3d
import numpy as np
from birm3d import filters, reference, units
from matplotlib.figure import Figure
from scipy.optimize import least_squares

NAMES = (
    "rails [MPa]",
    "engine [MPa]",
    "behind [MPa]",
    "unloading - steepest [MPa/m]",
    "rails at [m]",
    "engine at [m]",
)
# Measured value and the difference that counts as one: a few per cent, what repeated tests of a car scatter.
TARGETS = {
    "max_displacement": (0.677, 0.008),
    "time_of_zero_velocity": (0.0730, 0.0015),
    "restitution": (0.20, 0.02),
    "peak_normal_force_cfc60": (678e3, 30e3),
}
RAMP = 0.10  # length over which the engine meets the fire wall, m
CURVE_WEIGHT = 3.0 / 50e3  # of the root mean square difference of the force, per N


def front(car: birm3d.Vehicle, numbers: np.ndarray) -> birm3d.Vehicle:
    """Return the car with the envelope that six numbers give."""
    rails, engine, behind, above = np.exp(numbers[:4]) * 1e6
    start, meets = numbers[4:]
    unloading = (engine - rails) / RAMP + above  # below the steepest slope unloading would create energy
    envelope = (
        (0.0, 0.0),
        (start, rails),
        (meets, rails),
        (meets + RAMP, engine),
        (meets + 0.18, engine),
        (meets + 0.30, behind),
        (0.75, behind),
        (1.25, 1.1e6),  # beyond what the test reached
    )
    for zone in ("bumper", "engine_bay"):
        car = car.with_zone(zone, envelope=envelope, k_unloading=unloading)
    return car


def crash(car: birm3d.Vehicle, duration: float | None = 0.13) -> birm3d.Result:
    wall = birm3d.Barrier.rigid_wall()
    return birm3d.Simulation(car, wall, units.km_h(57.09), duration=duration).run()


def wall_force(result: birm3d.Result) -> np.ndarray:
    return filters.cfc(result.barrier_normal_force, 60, result.scene.settings.output_interval)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--output", type=Path, help="folder for the figure")
    options = parser.parse_args()

    car = birm3d.Vehicle.preset("passenger_car", gvw=1719.0)
    test = reference.nhtsa_10146()
    measured = test["wall_force"][:130]

    def residuals(numbers: np.ndarray) -> np.ndarray:
        result = crash(front(car, numbers))
        force = wall_force(result)[::10]
        curve = (force[:130] - measured) * CURVE_WEIGHT / np.sqrt(130.0)
        scalars = [(result.metrics[name] - value) / size for name, (value, size) in TARGETS.items()]
        return np.concatenate([curve, scalars])

    shipped = car.zones["bumper"]
    (_, _), (start, rails), (meets, _), (_, engine), _, (_, behind), *_ = shipped.envelope
    above = shipped.k_unloading - (engine - rails) / RAMP
    now = np.array([*np.log(np.array([rails, engine, behind, above]) / 1e6), start, meets])
    low = np.array([*np.log([0.05, 0.5, 0.05, 0.05]), 0.05, 0.18])
    high = np.array([*np.log([0.4, 1.5, 0.8, 30.0]), 0.17, 0.35])
    fits = []
    for shift in (0.0, 0.08, -0.08):
        begin = np.clip(
            now * (1.0 + np.array([0.0, 1.0, -1.0, 1.0, 1.0, -1.0]) * shift), low + 1e-3, high - 1e-3
        )
        fits.append(least_squares(residuals, begin, bounds=(low, high), diff_step=2e-3, max_nfev=25))
    best = min(fits, key=lambda fit: fit.cost)
    spread = np.sqrt(np.diag(np.linalg.inv(best.jac.T @ best.jac)))

    print(f"cost from three starts: {', '.join(f'{fit.cost:.3f}' for fit in fits)}\n")
    print(f"{'':28s}{'in the file':>12s}{'fitted':>10s}{'+-':>8s}")
    for i, name in enumerate(NAMES):
        scale = np.exp(best.x[i]) if i < 4 else 1.0
        value = scale if i < 4 else best.x[i]
        print(f"{name:28s}{np.exp(now[i]) if i < 4 else now[i]:12.3f}{value:10.3f}{scale * spread[i]:8.3f}")
    metrics = crash(front(car, best.x), None).metrics
    print(f"\n{'':26s}{'fitted':>10s}{'measured':>10s}")
    for name, (value, _) in TARGETS.items():
        print(f"{name:26s}{metrics[name]:10.4g}{value:10.4g}")

    if options.output:
        options.output.mkdir(parents=True, exist_ok=True)
        fig = Figure(figsize=(6.5, 4.0), layout="constrained")
        axes = fig.subplots()
        axes.plot(test["time"] * 1e3, test["wall_force"] / 1e3, "k", lw=1.0, label="NHTSA 10146")
        for label, numbers in (("in the file", now), ("fitted", best.x)):
            result = crash(front(car, numbers))
            axes.plot(
                result.time * 1e3,
                wall_force(result) / 1e3,
                label=label,
                ls="--" if numbers is best.x else "-",
            )
        axes.set(xlabel="time [ms]", ylabel="wall force, CFC 60 [kN]", xlim=(0.0, 130.0))
        axes.legend(frameon=False)
        axes.grid(alpha=0.3)
        fig.savefig(options.output / "fit_sedan_front.png", dpi=150)


if __name__ == "__main__":
    main()
