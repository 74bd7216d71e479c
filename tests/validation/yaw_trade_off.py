"""What less yaw of N at the wall at 25 degrees costs: fits with that yaw held from loosely to firmly.

python tests/validation/yaw_trade_off.py    # writes results/finite_element_yaw.csv; page.py makes the table

Fits as in fit_finite_element.py, from what is expected only. The last row is a fit to this run alone.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "bench"))

from comparison import write_rows
from finite_element_fit import YAW_MARK, fit, predicted
from finite_element_skin import SKINS, vehicle_with
from fit_finite_element import RESULTS, Row, known_runs
from page import within

SIGMAS = (10.0, 5.0, 2.5, 1.25)  # deg


@dataclass(frozen=True)
class TradeOff:
    """The wall at 25 degrees by a fit, and how many of all runs of the vehicle are within their marks.

    sigma: error of the yaw that counts as one residual [deg]. runs: "all", or "this one".
    """

    vehicle: str  # as in other tables of results
    runs: str
    sigma: float
    crush: float
    crush_measured: float
    peak_force: float
    peak_force_measured: float
    yaw: float
    yaw_measured: float
    crush_within: int
    force_within: int
    yaw_within: int
    of: int


def trade_off(sigma: float, alone: bool, steps: int) -> TradeOff:
    """One row of the table."""
    skin, known = SKINS["n"], known_runs("n")
    oblique = next(run for run in known if run.impact_angle != 90.0)
    found = fit(skin, [oblique] if alone else known, steps, 1, {oblique.name: sigma})
    vehicle = vehicle_with(skin, skin.values(found.shares), "trade-off")
    rows = {run.name: Row.of(run, "fitted", predicted(vehicle, run)[0]) for run in known}
    kept = [within({name: str(value) for name, value in asdict(row).items()}) for row in rows.values()]
    crush, force, yaw = (sum(column) for column in zip(*kept, strict=True))
    row = rows[oblique.name]
    return TradeOff(
        row.vehicle,
        "this one" if alone else "all",
        sigma,
        row.crush,
        row.crush_measured,
        row.peak_force,
        row.peak_force_measured,
        row.yaw,
        row.yaw_measured,
        crush,
        force,
        yaw,
        len(known),
    )


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--steps", type=int, default=12, help="most of a fit")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    options = parser.parse_args(arguments)
    cases = [*((sigma, False) for sigma in SIGMAS), (0.5 * YAW_MARK, True)]
    with ProcessPoolExecutor(options.jobs) as pool:
        sigmas, alone = zip(*cases, strict=True)
        rows = list(pool.map(trade_off, sigmas, alone, [options.steps] * len(cases)))
    write_rows(RESULTS / "finite_element_yaw.csv", rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
