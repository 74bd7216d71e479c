"""What holds at the extremes: stiffness, steps, speeds, masses, angles and more, judged by the balances.

    python tests/bench/bench_stability.py [--axes NAME ...] [--save]

birm3d.study.stability: a car at 25 deg at a wall and head-on at bollards, a block head-on at a wall, and
vehicles of laboratories. Ends with 1 if any scene neither held nor was refused with a reason. --save writes
table and figure to results/robustness/stability.csv and .png.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from birm3d.study import stability
from birm3d.study.verification.stability_cases import AXES

RESULTS = Path(__file__).parent / "results/robustness"


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--axes", nargs="+", choices=AXES, help="those wanted (default: all)")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/robustness")
    options = parser.parse_args(arguments)
    found = stability(axes=options.axes)
    print(found.report())
    if options.save:
        RESULTS.mkdir(parents=True, exist_ok=True)
        found.save(RESULTS / "stability.csv")
        found.plot().savefig(RESULTS / "stability.png", dpi=80)
    return 1 if found.faults else 0


if __name__ == "__main__":
    sys.exit(main())
