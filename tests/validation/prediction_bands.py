"""The 80 % bands of birm3d.predict beside tests: one test is left out, the scatter is that of the others.

    python tests/validation/prediction_bands.py

writes tests/validation/prediction_bands.md, and prints the numbers of the blocks [[scatter]] of the presets.
For each test the factor on the preset's stresses is sought that meets it. The factors of the other tests have
a mean and a standard deviation, and with these the band of the test left out is drawn.
"""

from __future__ import annotations

import csv
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist

import birm3d
import numpy as np
import numpy.typing as npt

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "bench")]

import fit_sides  # noqa: E402
import kind_small_overlap  # noqa: E402
from birm3d import Simulation, scenes  # noqa: E402
from birm3d.reference import NhtsaTest, nhtsa_tests  # noqa: E402
from birm3d.scene_parameters import varied  # noqa: E402
from birm3d.study.predict import draws, quantiles  # noqa: E402
from comparison import facts  # noqa: E402

PAGE = HERE / "prediction_bands.md"
PEAKS = HERE / "measured" / "peak_decelerations.csv"
Floats = npt.NDArray[np.float64]

LN_FACTORS = np.linspace(-0.9, 0.9, 7)
FRONT = ("engine", "bumper", "engine_bay")
SHARE = 0.8
NORMAL = NormalDist()
Z = NORMAL.inv_cdf(0.5 + 0.5 * SHARE)
DRAWS = 5  # power of two
MESH = 0.3


@dataclass(frozen=True)
class Case:
    """A test, what the preset gives at each factor, and what was measured."""

    test: NhtsaTest
    preset: str
    curves: Mapping[str, Floats]
    measured: Mapping[str, float]

    def at(self, quantity: str, ln_factor: float | Floats) -> Floats:
        """The quantity at logarithms of factors."""
        return np.interp(ln_factor, LN_FACTORS, self.curves[quantity])

    def ln_factor(self, quantity: str) -> float:
        """The logarithm of the factor that meets the test; at an end where none does."""
        curve = self.curves[quantity]
        return float(np.interp(-self.measured[quantity], -curve, LN_FACTORS))


def curves(simulation: Simulation, zones: Sequence[str], metrics: Mapping[str, str]) -> dict[str, Floats]:
    """Each metric at each factor on the stresses of some zones."""
    runs = [
        varied(simulation, {f"zone.{zone}.scale": math.exp(q) for zone in zones}).run().metrics
        for q in LN_FACTORS
    ]
    return {name: np.array([run[metric] for run in runs]) for name, metric in metrics.items()}


def peaks() -> dict[str, float]:
    """Peak deceleration of the compartment by the test's number [m/s^2]."""
    lines = (line for line in PEAKS.read_text().splitlines() if not line.startswith("#"))
    return {row["test"]: float(row["peak_deceleration_m_s2"]) for row in csv.DictReader(lines)}


def front_cases() -> list[Case]:
    """Frontal tests at 56 km/h with a usable pulse."""
    peak = peaks()
    known: dict[tuple[str, float], dict[str, Floats]] = {}
    cases = []
    for number, test in nhtsa_tests().items():
        usable = test.kind == "frontal" and test.quality in ("A", "B") and test.speed > 15.0
        if not usable or test.dynamic_displacement is None:
            continue
        preset = scenes.preset_for(test)
        key = (preset, round(test.speed, 2))  # the same crash at every mass: Vehicle.scaled_to
        if key not in known:
            metrics = {"displacement": "max_displacement", "peak": "peak_deceleration_cfc60"}
            known[key] = curves(scenes.nhtsa_frontal(number, mesh_density=MESH), FRONT, metrics)
        measured = {"displacement": test.dynamic_displacement, "peak": peak[number]}
        cases.append(Case(test, preset, known[key], measured))
    return cases


def side_cases() -> list[Case]:
    """Poles into the side."""
    cases = []
    for test in (*fit_sides.rows("CALIBRATE"), *fit_sides.rows("EXTRA")):
        preset = scenes.preset_for(test)
        found = curves(fit_sides.scene(test, MESH), fit_sides.SIDES[preset], {"crush": "residual_crush"})
        assert test.static_crush is not None  # the table has it of every pole test
        cases.append(Case(test, preset, found, {"crush": test.static_crush}))
    return cases


@dataclass(frozen=True)
class Coverage:
    """How many tests lie in their bands, and how wide these are beside the tests' own scatter."""

    what: str
    n: float
    inside: float
    width: float  # median of ln(high / low)
    scatter: float  # that of the tests of the class: 2 Z standard deviations of ln


def pooled(cases: Sequence[Case], quantity: str) -> float:
    """Standard deviation of the logarithms of the factors about their presets' means."""
    groups = [[case.ln_factor(quantity) for case in cases if case.preset == name] for name in fit_sides.HEAD]
    squares = sum(float(np.var(group)) * len(group) for group in groups if group)
    return math.sqrt(squares / (len(cases) - sum(1 for group in groups if group)))


def left_out(
    cases: Sequence[Case],
    what: str,
    quantity: str,
    fitted: str,
    keep: Callable[[Case], bool] = lambda case: True,
) -> Coverage:
    """Leave each test out in turn: bands of a quantity by the factors that meet another one, or the same."""
    normal = draws(DRAWS)["front"]
    inside, widths, logs = 0, [], []
    wanted = [case for case in cases if keep(case)]
    for case in wanted:
        others = [other for other in cases if other is not case]
        near = [other.ln_factor(fitted) for other in others if other.preset == case.preset]
        mean, spread = float(np.mean(near)), pooled(others, fitted)
        if len(near) >= 20:  # enough to have a spread of their own
            spread = float(np.std(near, ddof=1))
        values = case.at(quantity, mean + spread * normal)
        if quantity == "peak":  # compartment beside mass centre: the mean ratio of the others
            ratios = [o.measured["peak"] / o.at("peak", o.ln_factor(fitted)) for o in others]
            values = values * math.exp(float(np.mean(np.log(ratios))))
        low, _, high = quantiles(values, SHARE)
        inside += low <= case.measured[quantity] <= high
        widths.append(math.log(high / low))
        own = [o.measured[quantity] for o in wanted if o.preset == case.preset]
        logs += [math.log(case.measured[quantity]) - float(np.mean(np.log(own)))]
    scatter = 2.0 * Z * float(np.std(logs, ddof=len(fit_sides.HEAD)))
    return Coverage(what, len(wanted), inside / len(wanted), float(np.median(widths)), scatter)


def small_overlap() -> list[Coverage]:
    """Change of velocity in the small overlap: shares of 150 tests, as normal by their quartiles."""
    runs = []
    for name in kind_small_overlap.VEHICLES:
        study = birm3d.predict(kind_small_overlap.simulation(name), metrics=["delta_v"]).study
        for row in range(len(study)):
            runs.append(study.simulation(row).run())
    found = []
    for fact in facts("small_overlap"):
        time, along = float(fact["time_s"]), fact["direction"] == "along"
        values = []
        for result in runs:
            change = np.cumsum(result.acceleration[1:, 0 if along else 1])
            change *= result.scene.settings.output_interval
            values.append(abs(float(np.interp(time, result.time[1:], change))))
        low, _, high = quantiles(np.array(values), SHARE)
        lower, upper = sorted(abs(float(fact[f"{q}_quartile_m_s"])) for q in ("lower", "upper"))
        sigma = (upper - lower) / (2.0 * NORMAL.inv_cdf(0.75))
        middle = abs(float(fact["median_m_s"]))
        share = NORMAL.cdf((high - middle) / sigma) - NORMAL.cdf((low - middle) / sigma)
        what = f"small overlap, change of velocity {fact['direction']} at {1e3 * time:.0f} ms"
        scatter = math.log((middle + Z * sigma) / max(middle - Z * sigma, 0.05 * middle))
        found.append(Coverage(what, 150, share, math.log(high / low), scatter))
    return found


def factors(cases: Sequence[Case], quantity: str) -> list[tuple[str, int, float, float, float]]:
    """Preset, number of tests, median factor, standard deviation of its logarithm, the pooled one."""
    rows = []
    for name in fit_sides.HEAD:
        own = [case.ln_factor(quantity) for case in cases if case.preset == name]
        rows.append(
            (
                name,
                len(own),
                math.exp(float(np.mean(own))),
                float(np.std(own, ddof=1)),
                pooled(cases, quantity),
            )
        )
    return rows


HEAD = """# Bands of `birm3d.predict` beside tests

Written by `python tests/validation/prediction_bands.py`. One test is left out at a time, and its 80 % band is
drawn with the scatter of the others: the factor on a preset's stresses that meets each of them. Groups with
fewer than 20 tests have the standard deviation of all, each about its group's mean. A good band holds 80 % of
the tests (70 to 90 % of samples of this size), and is not wider than the tests' own scatter.

The peak is that of the compartment's deceleration, which one channel has measured to 10 %; the model has that
of the mass centre. The mean ratio of the other tests stands between them. Shares of the small-overlap tests
are those of a normal distribution by their quartiles, with the scatter of the presets' files, friction and
tyres included. The scatter was not fitted to those tests, but two numbers of the model were: see
[the page of all tests](README.md).

| quantity | tests | inside the 80 % band | width of the band, ln(high / low) | of the tests | 70 to 90 % |
| --- | --- | --- | --- | --- | --- |
"""
NOTES = """
The small overlap is covered along the vehicle from 60 to 120 ms; at 150 ms the bands are too wide.
Before 60 ms the tests scatter more, as the width of bumpers is not varied. Across the vehicle 60 and 80 ms
are covered. From 100 ms on the presets are pushed aside too little.

## Factors that meet the tests

The blocks `[[scatter]]` of the presets have these numbers; a group with fewer than 20 tests has the pooled
standard deviation.

| quantity | preset | tests | median factor | its standard deviation (ln) | pooled |
| --- | --- | --- | --- | --- | --- |
"""


def main() -> int:
    """Write the page."""
    front, side = front_cases(), side_cases()
    rows = [
        left_out(front, "displacement, wall at 56 km/h", "displacement", "displacement"),
        left_out(front, "peak deceleration, wall at 56 km/h", "peak", "displacement"),
        left_out(side, "static crush, pole into the side", "crush", "crush"),
        *small_overlap(),
    ]
    lines = [
        f"| {row.what} | {row.n} | {row.inside:.0%} | {row.width:.2f} | {row.scatter:.2f} | "
        f"{'yes' if 0.7 <= row.inside <= 0.9 else 'no'} |"
        for row in rows
    ]
    found = [
        f"| {what} | `{name}` | {n} | {median:.2f} | {own:.2f} | {all_of:.2f} |"
        for what, cases, quantity in (("front", front, "displacement"), ("side", side, "crush"))
        for name, n, median, own, all_of in factors(cases, quantity)
    ]
    text = HEAD + "\n".join(lines) + "\n" + NOTES + "\n".join(found) + "\n"
    PAGE.write_text(text)
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
