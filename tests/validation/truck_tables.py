"""Runs of the truck, computed, as rows of tables with their marks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import birm3d
import numpy as np
from truck_runs import Figures, Run, figures, runs, scene

# What each is asked to be met within: shares, N s, deg.
MARKS = {"travel": 0.12, "force": 0.15, "sideways": 20e3, "pitch": 5.0}
MOMENT, ROLL = 0.15, 5.0  # marks of tests/validation/README.md alone: a share, deg


@dataclass(frozen=True, eq=False)
class Row:
    """A run, computed."""

    run: Run
    own: Figures

    @property
    def errors(self) -> dict[str, float]:
        """Greatest magnitudes of what MARKS has; relative of travel and force."""
        sideways = np.abs(self.own.impulse - self.run.impulse)[:, 1].max() if self.run.posts else 0.0
        return {
            "travel": self.own.travel / self.run.travel - 1.0,
            "force": self.own.force_50ms / self.run.force_50ms - 1.0,
            "sideways": float(sideways),
            "pitch": self.own.pitch - self.run.pitch,
        }

    @property
    def met(self) -> dict[str, bool]:
        return {name: abs(self.errors[name]) <= mark for name, mark in MARKS.items()}


def computed(vehicle: birm3d.Vehicle, chosen: Sequence[Run] | None = None) -> list[Row]:
    """The runs, or some of them, with a vehicle."""
    every = list(runs().values()) if chosen is None else chosen
    return [Row(run, figures(scene(vehicle, run).run())) for run in every]


HEAD = (
    "run",
    "travel [m]",
    "error",
    "force over 50 ms [kN]",
    "error",
    "impulse to the left, each post [kN s]",
    "pitch [deg]",
    "yaw [deg]",
)


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of a table, Markdown."""
    return [_line(head), _line(["---"] * len(head)), *(_line(cells) for cells in rows)]


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _marked(text: str, met: bool) -> str:
    return text if met else f"**{text}**"


def cells(row: Row) -> list[str]:
    """What HEAD names; in brackets the run, bold what is not met."""
    run, own, error, met = row.run, row.own, row.errors, row.met
    pairs = zip(1e-3 * own.impulse[:, 1], 1e-3 * run.impulse[:, 1], strict=True)
    sideways = "; ".join(f"{new:.0f} ({old:.0f})" for new, old in pairs)
    return [
        run.name,
        f"{own.travel:.2f} ({run.travel:.2f})",
        _marked(f"{100 * error['travel']:+.0f} %", met["travel"]),
        f"{1e-3 * own.force_50ms:.0f} ({1e-3 * run.force_50ms:.0f})",
        _marked(f"{100 * error['force']:+.0f} %", met["force"]),
        _marked(sideways, met["sideways"]) if run.posts else "",
        _marked(f"{own.pitch:.1f} ({run.pitch:.1f})", met["pitch"]),
        f"{own.yaw:.0f} ({run.yaw:.0f})",
    ]


def count(rows: Sequence[Row]) -> str:
    """How many marks are met."""
    posts = [row for row in rows if row.run.posts]
    counted = {name: posts if name == "sideways" else rows for name in MARKS}
    parts = [f"{name} {sum(row.met[name] for row in of)} of {len(of)}" for name, of in counted.items()]
    total = sum(row.met[name] for name, of in counted.items() for row in of)
    return f"{', '.join(parts)}; together {total} of {sum(map(len, counted.values()))}"


SCORE_HEAD = (
    "mean error of travel [%]",
    "of force [%]",
    "sideways [kN s]",
    "of pitch [deg]",
    "root mean square, in marks",
    "marks met",
)


def score(rows: Sequence[Row]) -> list[str]:
    """What SCORE_HEAD names."""
    mean = {name: float(np.mean([abs(row.errors[name]) for row in rows])) for name in MARKS}
    posts = [row for row in rows if row.run.posts]
    counted = {name: posts if name == "sideways" else rows for name in MARKS}
    shares = [row.errors[name] / MARKS[name] for name, of in counted.items() for row in of]
    return [
        f"{100 * mean['travel']:.0f}",
        f"{100 * mean['force']:.0f}",
        f"{1e-3 * float(np.mean([row.errors['sideways'] for row in posts])):.0f}",
        f"{mean['pitch']:.1f}",
        f"{float(np.sqrt(np.mean(np.square(shares)))):.2f}",
        f"{sum(abs(share) <= 1.0 for share in shares)} of {len(shares)}",
    ]
