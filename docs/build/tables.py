"""Tables of the site, made from committed results and from the package: ``<!-- build: table NAME -->``."""

from __future__ import annotations

import csv
import inspect
import logging
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
BENCH, VALIDATION = ROOT / "tests/bench/results", ROOT / "tests/validation/results"
ALL_TESTS = ROOT / "tests/validation/README.md"
RATINGS = ROOT / "tests/validation/ratings.md"
MARK = re.compile(r"^<!-- build: (table|text) (\w+) -->$", re.MULTILINE)
Row = dict[str, str]
_log = logging.getLogger("mkdocs.hooks.tables")


def rows_of(path: Path) -> list[Row]:
    """Return the rows of a table; lines that begin with # tell of the machine."""
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(
        "| " + " | ".join(str(cell).replace("|", "\\|") for cell in line) + " |" for line in lines
    )


def percent(text: str) -> str:
    """Return a share as per cent with two digits; a dash where there is none."""
    return "–" if text == "-" else f"{100.0 * float(text):.2g} %"


def accuracy_errors() -> str:
    """Worst metric of each case, by its error at the default tolerance."""
    cases: dict[str, list[Row]] = {}
    for row in rows_of(BENCH / "accuracy/converged.csv"):
        cases.setdefault(row["case"], []).append(row)

    def shown(rows: list[Row], column: str) -> str:
        worst = max(rows, key=lambda row: float(row[column] or 0.0))
        return f"{percent(worst[column])} ({worst['metric']})"

    body = [
        (case.replace("_", " "), shown(rows, "default_error"), shown(rows, "strict_error"))
        for case, rows in cases.items()
    ]
    return table(("case", "default tolerance 1e-3", "strict, 1e-5"), body)


def accuracy_claims() -> str:
    """What is claimed, and in how many cases it holds."""
    claims: dict[str, list[bool]] = {}
    for row in rows_of(BENCH / "accuracy/claims.csv"):
        claims.setdefault(row["claim"], []).append(row["holds"] == "yes")
    return table(("claim", "holds"), [(k, f"in {sum(v)} of {len(v)} cases") for k, v in claims.items()])


def mesh() -> str:
    """Error of each preset's own mesh."""
    rows = [row for row in rows_of(BENCH / "convergence/mesh.csv") if row["error_of_density_1"]]
    kept = [row for row in rows if row["metric"] in {"dynamic_crush", "peak_normal_force_cfc60", "end_speed"}]
    return table(
        ("scene", "metric", "order", "error of density 1"),
        [(r["scene"], r["metric"], r["order"], percent(r["error_of_density_1"])) for r in kept],
    )


def rivals() -> str:
    """Times at an error of 0.1 % of W2, N = 1,000 and 10,000."""
    rows = [
        row
        for row in rows_of(BENCH / "rivals/work_precision.csv")
        if row["case"] in {"W1", "W2"} and row["nodes"] in {"1000", "10000"} and row["target"] == "0.001"
    ]
    return table(
        ("case", "nodes", "program", "time", "times ours"),
        [
            (r["case"], r["nodes"], r["rival"], f"{r['time_ms']} ms", r["times_ours"])
            for r in rows
            if r["time_ms"]
        ],
    )


def determinism() -> str:
    """Hashes by scene, and from how many rows."""
    scenes: dict[str, set[str]] = {}
    rows = rows_of(BENCH / "determinism/hashes.csv")
    for row in rows:
        scenes.setdefault(row["scene"], set()).update(row["hash"].split("/"))
    each = len(rows) // len(scenes)
    head = ("scene", "different hashes", f"of {each} combinations of build and way to run")
    return table(
        head, [(scene, str(len(found)), "; ".join(sorted(found))) for scene, found in scenes.items()]
    )


def blind() -> str:
    """Blind predictions of NHTSA wall tests."""
    rows = [row for row in rows_of(BENCH / "predictions/nhtsa_frontal.csv") if row["measured_m"]]
    names = {"similar_m": "similar front", "same_front_m": "the preset's front", "in_between_m": "in between"}
    body = []
    for column, name in names.items():
        errors = sorted(float(r[column]) / float(r["measured_m"]) - 1.0 for r in rows if r[column])
        sizes = sorted(abs(e) for e in errors)
        mean = sum(errors) / len(errors)
        body.append((name, str(len(errors)), f"{100 * sizes[len(sizes) // 2]:.0f} %", f"{100 * mean:+.0f} %"))
    return table(("front", "tests", "median size of the error of travel", "mean error"), body)


def finite_element() -> str:
    """How the two vehicles fare, fitted and left out."""
    body = []
    for name in ("n", "s"):
        for row in rows_of(VALIDATION / f"finite_element_{name}.csv"):
            if row["what"] != "left out":
                continue
            crush, force = (
                f"{float(row[c]) * scale:.{digits}f} ({float(row[c + '_measured']) * scale:.{digits}f})"
                for c, scale, digits in (("crush", 1.0, 3), ("peak_force", 1e-3, 0))
            )
            body.append((row["vehicle"], row["run"], crush, force))
    return table(
        ("vehicle", "run, left out", "crush [m], computed (run)", "peak force [kN], computed (run)"), body
    )


def by_kind() -> str:
    """How many rows of each kind of test are within their marks."""
    return "\n".join(_lines_by_kind())


def _lines_by_kind() -> list[str]:
    text = ALL_TESTS.read_text(encoding="utf-8").split("\n## By kind of test\n")[1].split("\n## ")[0]
    return [line for line in text.splitlines() if line.startswith("|")]


def counts_by_kind() -> dict[tuple[str, str, str], Row]:
    """Return the rows of :func:`by_kind` by kind, quantity and role."""
    head, _, *lines = ([cell.strip() for cell in line.split("|")[1:-1]] for line in _lines_by_kind())
    found, kind = {}, ""
    for cells in lines:
        row = dict(zip(head, cells, strict=True))
        kind = row["kind"] or kind
        found[kind, row["quantity"], row["role"]] = row
    return found


def ratings() -> str:
    """How many published tests are rated as they were."""
    return RATINGS.read_text(encoding="utf-8").split("\n## Ratings\n\n")[1].split("\n\n")[0]


# Rows of README.md: kind of test, the quantities that are counted, each by itself, and their role.
OBLIQUE = ("exit angle", "exit angle, limit", "greatest roll", "contained and upright")
TRUST = (
    ("Full-width rigid wall, head-on", ("travel", "static crush"), "predicted"),
    ("Rigid pole into the side", ("static crush",), "predicted"),
    (
        "Finite-element vehicles N and S: walls, oblique walls, poles",
        ("travel", "peak force CFC60", "yaw"),
        "left out",
    ),
    ("Finite-element truck: walls and bollards", ("overturning moment", "greatest roll"), "predicted"),
    ("Oblique impact on walls and concrete barriers", OBLIQUE, "predicted"),
    ("Lateral design loads of rails", ("force over 50 ms",), "predicted"),
    ("Trucks at bollards and walls, head-on", ("dynamic penetration",), "predicted"),
)
# Said beside the role: how far the rows of a kind are blind.
RESERVATIONS = {
    "Finite-element vehicles N and S: walls, oblique walls, poles": (
        "the law of N was chosen with all runs in view"
    )
}


def trust() -> str:
    """The table of README.md; a test compares it with that page."""
    counts = counts_by_kind()
    body = []
    for kind, quantities, role in TRUST:
        reservation = f"; {RESERVATIONS[kind]}" if kind in RESERVATIONS else ""
        told = "; ".join(_within(counts[kind, quantity, role]) for quantity in quantities)
        body.append((f"{kind} ({role}{reservation})", told))
    return table(("checked against", "result"), [*body, _greatest_error(), _same_bits()])


def _within(row: Row) -> str:
    """How many rows of a quantity are within their marks; that all are too small is told where it is so."""
    met, number = int(row["within the marks"]), int(row["rows"])
    small = ", all too small" if number > 1 and int(row["too small"]) == number else ""
    told = f"{row['quantity']} {met} of {number}{small}"
    if row["unit of the error"] == "–":
        return told
    error = f"{row['median error']} {row['unit of the error']}".replace("% of measured", "%")
    least = "at least " if row["quantity"].endswith("limit") else ""
    return f"{told}, {'median ' if number > 1 else ''}error {least}{error}"


def _greatest_error() -> tuple[str, str]:
    rows = rows_of(BENCH / "accuracy/converged.csv")
    cases = len({row["case"] for row in rows})
    worst = max(rows, key=lambda row: float(row["default_error"] or 0.0))
    name = worst["metric"].replace("_", " ")
    checked = f"the program's own converged answers, {cases} cases at default settings"
    return checked, f"greatest error of any metric {percent(worst['default_error'])} ({name})"


def _same_bits() -> tuple[str, str]:
    rows = rows_of(BENCH / "determinism/hashes.csv")
    scenes, builds = ({row[column] for row in rows} for column in ("scene", "build"))
    if len({(row["scene"], row["hash"]) for row in rows}) != len(scenes):
        raise ValueError("hashes.csv must have one hash for each scene: README.md says so")
    words = {7: "seven", 8: "eight"}
    text = f"each of {words[len(scenes)]} scenes ends in the same state"
    return (
        "compilers, instruction sets, threads",
        f"{text} in all {len(rows)} runs of {words[len(builds)]} builds",
    )


def robustness() -> str:
    """What 10,000 random impacts showed."""
    return table(
        ("barrier", "runs", "deepest node [m]", "deepest anchor [m]", "energy", "momentum", "faults"),
        [
            (
                r["kind"],
                r["runs"],
                r["node_depth_m"],
                r["anchor_depth_m"],
                r["energy"],
                r["momentum"],
                r["faults"],
            )
            for r in rows_of(BENCH / "robustness/random_impacts.csv")
        ],
    )


def metrics() -> str:
    """Every scalar with its unit and its meaning."""
    from birm3d.result.metric_table import GROUPS, METRICS

    ordered = sorted(METRICS.items(), key=lambda item: GROUPS.index(item[1].group))
    rows = [(f"`{name}`", metric.unit or "–", metric.meaning) for name, metric in ordered]
    return table(("name", "unit", "meaning"), rows)


def settings() -> str:
    """Every setting with its default and meaning, from the docstring."""
    import griffe
    from birm3d import Settings

    parsed = griffe.Docstring(inspect.getdoc(Settings) or "", parser="numpy").parse(warnings=False)
    told = {p.name: p.description for part in parsed if part.kind.value == "parameters" for p in part.value}
    body = [
        (f"`{p.name}`", f"`{p.default!r}`", " ".join(told[p.name].split()).replace("``", "`"))
        for p in inspect.signature(Settings).parameters.values()
    ]
    return table(("name", "default", "meaning"), [(a, b, _plain(c)) for a, b, c in body])


def barriers() -> str:
    """Makers of barriers with the first sentence of their docstrings."""
    from birm3d import Barrier

    makers = [
        (name, inspect.getdoc(getattr(Barrier, name)) or "")
        for name, member in vars(Barrier).items()
        if isinstance(member, staticmethod) and not name.startswith("_")
    ]
    if not makers:
        raise ValueError("Barrier must have static methods that make barriers, got none")
    return table(("maker", "makes"), [(f"`Barrier.{n}`", _plain(d.split("\n\n")[0])) for n, d in makers])


def tutorial_report() -> str:
    """The tutorial's report, computed anew."""
    import birm3d
    from birm3d import units

    car = birm3d.Vehicle.preset("passenger_car", gvw=units.lb(4500))
    wall = birm3d.Barrier.rigid_wall(friction=0.2)
    result = birm3d.Simulation(car, wall, impact_speed=units.mph(35), impact_angle=60.0).run()
    return f"```text\n{result.report()}\n```"


def design_loads() -> str:
    """The table of the page on design loads, of the elements that are touched."""
    import birm3d
    from birm3d import units

    truck = birm3d.Vehicle.preset("cargo_truck")
    crash = birm3d.Simulation(truck, birm3d.Barrier.bollards(), impact_speed=units.mph(30))
    offsets = [0.0, 0.15, 0.3, 0.45, 0.6]
    loads = birm3d.design_load(crash, natural_period="50 ms", ductility=3, offsets=offsets)
    lines = [line for line in loads.to_markdown().splitlines() if line.startswith("|")]
    return "\n".join([*lines[:2], *(line for row, line in zip(loads, lines[2:], strict=True) if row.touched)])


def parapet_loads() -> str:
    """Test 3-11 of MASH at a rigid barrier, beside the design force of AASHTO."""
    import birm3d

    tests = birm3d.test_matrix("MASH TL-3", barrier=birm3d.Barrier.jersey())
    (row,) = birm3d.design_load(tests, natural_period=0.1)
    rows = (
        ("MASH TL-3 tests at a rigid New Jersey barrier, computed", row.force_50ms, row.height),
        ("AASHTO LRFD, Table A13.2-1, TL-3 (54 kip at 24 in)", birm3d.lateral_load.TL_3_FORCE, 24 * 0.0254),
    )
    body = [(name, f"{force / 1e3:.0f}", f"{height:.2f}") for name, force, height in rows]
    return table(("", "50-ms force [kN]", "height [m]"), body)


def limits() -> str:
    """The answers of the page on limits."""
    import birm3d
    from birm3d import units

    truck = birm3d.Vehicle.preset("cargo_truck")
    crash = birm3d.Simulation(truck, birm3d.Barrier.bollards(count=7), impact_speed=units.mph(30))
    tubes = birm3d.Barrier.bollards(count=7, diameter=0.273, wall_thickness=0.02)
    yields = birm3d.Simulation(truck, tubes, impact_speed=units.mph(30))
    row = birm3d.Barrier.jersey(length=60.0, segments=15, free_standing=True)
    pickup = birm3d.Simulation(birm3d.Vehicle.preset("pickup"), row, impact_speed="100 km/h", impact_angle=25)
    found = (
        birm3d.greatest_gap(crash, gaps=(0.5, 3.0)),
        birm3d.least_height(crash, heights=(0.3, 1.3)),
        birm3d.least_tube_thickness(yields, thicknesses=(0.004, 0.03), deflection=0.5),
        birm3d.least_segment_mass(pickup, masses=(500, 8000), deflection=0.8),
    )
    worst = birm3d.worst_offset(crash, spacings=[1.2, 1.5, 1.8, 2.1])
    rows = [(limit.headline, str(len(limit.runs))) for limit in found]
    for one in worst.rows:
        runs = len(one.search.grid) + len(one.search.refinement)
        text = f"worst offset at a spacing of {one.spacing:g} m: {one.share:.2f} of it from a post"
        rows.append((f"{text}, {one.value / 1e3:.0f} kN m", str(runs)))
    return table(("answer", "runs"), rows)


def _plain(text: str) -> str:
    return re.sub(r":\w+:`~?([^`]+)`", r"`\1`", " ".join(text.split()))


MADE: dict[str, Callable[[], str]] = {
    made.__name__: made
    for made in (
        accuracy_errors, accuracy_claims, mesh, rivals, determinism, by_kind, ratings, blind, finite_element,
        robustness, metrics, settings, barriers, tutorial_report, design_loads, parapet_loads, limits,
    )
}  # fmt: skip


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Put tables in the place of their marks."""

    def made(match: re.Match[str]) -> str:
        name = match.group(2)
        if name not in MADE:
            _log.warning("%s: no table %s", page.file.src_uri, name)
            return match.group(0)
        return MADE[name]()

    return MARK.sub(made, markdown)
