"""Loads on single posts against diameter and offset: writes posts.md and results/posts.csv.

    python tests/validation/posts.py    # half a minute

Head-on, one rigid post, no friction. The site draws the tables but those of post_ratios.py. Figures of finite
elements are those of tests/data/finite_element: poles of 0.354 m at 30 mph.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent / "bench")]

import post_ratios  # noqa: E402
from comparison import write_rows  # noqa: E402
from finite_element import POLE_DIAMETER  # noqa: E402
from post_runs import crash, half_width, impulse, speed, vehicle  # noqa: E402

RESULTS = FOLDER / "results/posts.csv"
VEHICLES = ("fitted_n", "fitted_s", "passenger_car", "pickup", "fitted_truck")
DIAMETERS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)  # m
SHARES = (0.0, 0.15, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0, 1.1, 1.3)  # of the half width

INTRODUCTION = """# Loads on single posts

Written by `python tests/validation/posts.py`. One rigid post of 1.5 m, head-on, without friction: vehicles N
and S at 30 mph, presets at 56 km/h, the finite-element truck at 50 mph.
"""
BY_DIAMETER = """
## Against the diameter

The post stands before the middle. A thicker post meets more of the front at once.
"""
BY_OFFSET = """
## Against the offset

Post of 0.354 m. Ratio: sideways over forward impulse on the post. Offset: of the post's axis, as a share of
the vehicle's half width. The post touches nothing beyond 1 + radius over half width.

Finite elements: 0.13 for vehicle N at 0.50 of its half width.
"""


@dataclass(frozen=True)
class Load:
    """What one post takes in a crash; impulses on the post [N s], forward and to the vehicle's left."""

    vehicle: str
    diameter: float  # m
    offset_share: float  # of the half width, post to the right
    travel: float  # m
    peak_force: float  # resultant, CFC60 [N]
    force_50ms: float  # greatest mean of the resultant over 50 ms [N]
    forward: float
    left: float

    @property
    def ratio(self) -> float:
        """Sideways over forward impulse; nought where nothing is touched."""
        return abs(self.left) / self.forward if self.forward > 1.0 else 0.0


def load(name: str, diameter: float, share: float) -> Load:
    """Run the crash of a vehicle at a post, which stands a share of its half width to the right."""
    who = vehicle(name)
    result = crash(who, speed(name), share * half_width(who), diameter=diameter)
    forward, left = impulse(result)
    return Load(
        name,
        diameter,
        share,
        float(result.position[:, 0].max() - result.position[0, 0]),
        float(result.metrics["peak_normal_force_cfc60"]),
        float(result.metrics["peak_force_50ms"]),
        float(forward),
        float(left),
    )


def loads() -> Iterator[Load]:
    """Every crash of the page."""
    for name in VEHICLES:
        for diameter in DIAMETERS:
            yield load(name, diameter, 0.0)
        for share in SHARES:
            yield load(name, POLE_DIAMETER, share)
        print(name, flush=True)


def _table(title: str, heads: Sequence[str], rows: Sequence[Load], text: Callable[[Load], str]) -> str:
    lines = ["", f"**{title}**", "", f"| vehicle | {' | '.join(heads)} |", "|---" * (len(heads) + 1) + "|"]
    for name in VEHICLES:
        cells = [text(row) for row in rows if row.vehicle == name]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines)


def page(found: Sequence[Load]) -> str:
    """The tables against diameter and offset, with a row for each vehicle."""
    parts = [INTRODUCTION, BY_DIAMETER]
    centered = [row for row in found if row.diameter in DIAMETERS and row.offset_share == 0.0]
    for title, value in (
        ("Peak force CFC60 [kN] by diameter [m]", lambda row: f"{1e-3 * row.peak_force:,.0f}"),
        ("Greatest mean over 50 ms [kN] by diameter [m]", lambda row: f"{1e-3 * row.force_50ms:,.0f}"),
    ):
        parts.append(_table(title, [f"{d:g}" for d in DIAMETERS], centered, value))
    beside = [row for row in found if row.diameter == POLE_DIAMETER]
    parts.append(BY_OFFSET)
    heads = [f"{share:g}" for share in SHARES]
    parts.append(_table("Ratio by offset", heads, beside, lambda row: f"{row.ratio:.2f}"))
    parts.append(
        _table("Forward impulse [kN s] by offset", heads, beside, lambda row: f"{1e-3 * row.forward:.1f}")
    )
    return "\n".join(parts)


def main() -> int:
    found = list(loads())
    write_rows(RESULTS, found)
    write_rows(post_ratios.RATIOS, list(post_ratios.ratios()))
    write_rows(post_ratios.PARTS, list(post_ratios.parts(post_ratios.read_ratios())))
    rest = post_ratios.section(post_ratios.read_ratios(), post_ratios.read_parts())
    (FOLDER / "posts.md").write_text(f"{page(found)}\n{rest.rstrip()}\n", encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
