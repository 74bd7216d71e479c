"""The page of all tests: counts and medians by kind, then the rows of each kind."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from statistics import median
from types import ModuleType

from comparison import RESULTS, TOLD, Row

UNSEEN = ("left out", "predicted")
# Magnitude below which a number is rounding alone, in the unit of the page.
_ROUNDING = 1e-9

INTRODUCTION = """# Predicted beside given tests

Written by `python tests/validation/all_tests.py` from data. The texts are those of
`kind_*.py`; no number of a table is typed in.

One table for each kind of test: measured, predicted, error. Which preset stands for a vehicle follows from
one rule (`stand_in.py`: the preset of the class that is nearest in mass, with the mass of the test); no row
has a number of its own. The mark of a quantity is the error that is accepted. Each kind says its marks, and
whether they are the scatter of tests, a bound or a target. An error beyond its mark is bold.

Travel is the greatest displacement of the mass centre towards the barrier. Static crush is what is left of
the crush after the test. Other words are in the [glossary](../../docs/pages/glossary.md).

The first table counts the rows of each quantity within their marks, and those whose magnitude is less than
the measured one. Its median error is that of magnitudes. A dash in place of a unit stands for ratios, counts,
and yes (1) or no (0). Where a source gives a limit only, the measured value is "at most", and an error above
it is "at least".

- fitted: the row was used in a fit of this vehicle. Of a vehicle that is fitted to runs as a whole, all rows
  of these runs are called so.
- left out: predicted by a fit to all rows of its vehicle but this one.
- predicted: no fit has seen the row.
- check: nothing was measured, or the mark is wide on one side by its nature. The row is in no count.

No test data: of exit speed and of the tilt of posts that yield no measured value was found. Of the
overturning moment at a foot there are finite-element runs only.

Figures whose source is not at hand are printed apart, at the end of a kind, and are in no count.
[Fits, and numbers set by hand](fits.md). Details: [vehicles N and S](finite_element.md),
[finite-element truck](truck.md), [corners](corners.md), [posts](posts.md).
"""


def page(modules: Mapping[str, ModuleType], tables: Mapping[str, Sequence[Row]]) -> str:
    """The text of README.md."""
    lines = [INTRODUCTION, "## By kind of test", "", *_summary(modules, tables), ""]
    lines += ["## The worst rows that no fit has seen", "", *_worst(tables), ""]
    for name, module in modules.items():
        lines += [f"## {module.TITLE}", "", module.TEXT, "", *_rows(tables[name]), ""]
        if name == "redirection":
            lines += [*_computed(), ""]
        memory = [row for row in tables[name] if not row.judged]
        if memory:
            lines += ["As commonly reported, source not at hand; not judged:", "", *_table(memory), ""]
    return "\n".join(lines).rstrip() + "\n"


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _rule(count: int) -> str:
    return "|" + "---|" * count


def _number(value: float, unit: str) -> str:
    factor, _ = TOLD.get(unit, (1.0, unit))
    if abs(factor * value) < _ROUNDING:
        return "0"
    return f"{factor * value:.3g}" if abs(factor * value) < 1000.0 else f"{factor * value:,.0f}"


def _unit(unit: str) -> str:
    return TOLD.get(unit, (1.0, unit))[1]


def quantities(rows: Sequence[Row]) -> list[str]:
    """Quantities of judged rows, in their order."""
    return list(dict.fromkeys(row.quantity for row in rows if row.judged))


def median_error(rows: Sequence[Row]) -> tuple[str, str]:
    """Median magnitude of the errors and its unit: per cent of what was measured, or the quantity's unit."""
    middle = median(abs(row.error) for row in rows)
    if rows[0].relative:
        return f"{100.0 * middle:.0f}", "% of measured"
    factor, unit = TOLD.get(rows[0].unit, (1.0, rows[0].unit))
    return f"{factor * middle:.2g}", "–" if unit == "-" else unit


def _summary(modules: Mapping[str, ModuleType], tables: Mapping[str, Sequence[Row]]) -> Iterator[str]:
    head = (
        "kind",
        "quantity",
        "role",
        "rows",
        "within the marks",
        "too small",
        "median error",
        "unit of the error",
    )
    yield _line(head)
    yield _rule(len(head))
    for name, module in modules.items():
        title = module.TITLE
        for quantity in quantities(tables[name]):
            for role in ("fitted", *UNSEEN):
                chosen = [
                    row
                    for row in tables[name]
                    if row.judged and row.quantity == quantity and row.role == role
                ]
                if not chosen:
                    continue
                met = sum(row.met for row in chosen)
                small = sum(abs(row.predicted) < abs(row.measured) for row in chosen)
                counts = (str(len(chosen)), str(met), str(small))
                yield _line((title, quantity, role, *counts, *median_error(chosen)))
                title = ""


def _worst(tables: Mapping[str, Sequence[Row]], count: int = 20) -> Iterator[str]:
    """Rows furthest outside their marks, in widths of the mark."""

    def beyond(row: Row) -> float:
        half = 0.5 * (row.high - row.low)
        outside = max(row.low - row.predicted, row.predicted - row.high)
        return outside / half if half > 0.0 else 0.0

    rows = [row for table in tables.values() for row in table if row.judged and row.role in UNSEEN]
    worst = sorted((row for row in rows if not row.met), key=beyond, reverse=True)[:count]
    yield "Ordered by how far they are outside their marks, in half widths of the mark.\n"
    head = ("test", "vehicle", "quantity", "measured", "predicted", "error", "outside by")
    yield _line(head)
    yield _rule(len(head))
    for row in worst:
        cells = (*_compared(row), row.error_text, f"{beyond(row):.1f}")
        yield _line(cells)


def _rows(rows: Sequence[Row]) -> list[str]:
    return _table([row for row in rows if row.judged])


def _table(rows: Sequence[Row]) -> list[str]:
    head = ("test", "vehicle", "quantity", "measured", "predicted", "error", "role")
    lines = [_line(head), _rule(len(head))]
    for row in rows:
        mark = row.error_text if row.met else f"**{row.error_text}**"
        lines.append(_line((*_compared(row), mark, row.role)))
    return lines


def _compared(row: Row) -> tuple[str, ...]:
    """Test, vehicle and quantity of a row, what was measured with its unit, and what was predicted."""
    measured, predicted = (_number(value, row.unit) for value in (row.measured, row.predicted))
    told = f"{'at most ' if row.is_limit else ''}{measured} {_unit(row.unit)}".removesuffix(" -")
    return row.test, row.vehicle, row.quantity, told, predicted


def _computed() -> list[str]:
    """Figures of oblique impacts, of which few were measured."""
    head = (
        "test",
        "vehicle",
        "outcome",
        "exit speed, m/s",
        "exit angle, deg",
        "roll, deg",
        "pitch, deg",
        "wall's impulse / m v sin a",
        "force over 50 ms, kN",
        "ASI",
    )
    path = Path(RESULTS) / "redirection_computed.txt"
    rows = [line.split("; ") for line in path.read_text(encoding="utf-8").splitlines()]
    return [
        "Computed; the few that were measured are above:",
        "",
        _line(head),
        _rule(len(head)),
        *map(_line, rows),
    ]
