"""Pictures of the site, made by the build: ``<!-- build: picture NAME -->``."""

from __future__ import annotations

import csv
import importlib.util
import itertools
import logging
import posixpath
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

ROOT = Path(__file__).resolve().parents[2]
BENCH, VALIDATION = ROOT / "tests/bench/results", ROOT / "tests/validation/results"
MARK = re.compile(r"^<!-- build: picture (\w+) -->$", re.MULTILINE)
_log = logging.getLogger("mkdocs.hooks.pictures")
_used: set[str] = set()


def sedan() -> Figure:
    """The sedan of NHTSA test 10146 and its test, as the example draws them."""
    import birm3d
    from birm3d.reference import nhtsa_10146

    path = ROOT / "examples/head_on_sedan.py"
    spec = importlib.util.spec_from_file_location("head_on_sedan", path)
    assert spec is not None
    assert spec.loader is not None
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    figure: Figure = example.figure(birm3d.scenes.nhtsa_10146().run(), nhtsa_10146())
    return figure


def tutorial() -> Figure:
    """What the tutorial plots."""
    import birm3d
    from birm3d import units

    car = birm3d.Vehicle.preset("passenger_car", gvw=units.lb(4500))
    wall = birm3d.Barrier.rigid_wall(friction=0.2)
    result = birm3d.Simulation(car, wall, impact_speed=units.mph(35), impact_angle=60.0).run()
    return result.plot()


def design_loads() -> Figure:
    """What the page on design loads plots."""
    import birm3d
    from birm3d import units

    truck = birm3d.Vehicle.preset("cargo_truck")
    crash = birm3d.Simulation(truck, birm3d.Barrier.bollards(), impact_speed=units.mph(30))
    offsets = [0.0, 0.15, 0.3, 0.45, 0.6]
    return birm3d.design_load(crash, natural_period=0.05, ductility=3, offsets=offsets).plot()


def limits() -> Figure:
    """The greatest gap on the page on limits."""
    import birm3d
    from birm3d import units

    truck = birm3d.Vehicle.preset("cargo_truck")
    crash = birm3d.Simulation(truck, birm3d.Barrier.bollards(count=7), impact_speed=units.mph(30))
    return birm3d.greatest_gap(crash).plot()


def truss_law() -> Figure:
    """Fig. 3: loading, unloading, reloading, computed by the core."""
    import numpy as np
    from birm3d import Zone

    zone = Zone(k_initial=1.0e6, knee=0.2, k_hardening=3.0e6, f_max=6.0e5, k_unloading=8.0e6)
    turns = [0.0, 0.25, 0.20, 0.34, 0.25]
    path = np.concatenate([np.linspace(a, b, 60) for a, b in itertools.pairwise(turns)])
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.add_subplot()
    envelope = np.linspace(0.0, 0.4, 200)
    axes.plot(envelope, [zone.curve.envelope(d) / 1e3 for d in envelope], ":", color="0.5", label="envelope")
    axes.plot(path, zone.curve.follow(path) / 1e3, color="C0", label="path with two unloadings")
    for text, place in {
        "k_initial": (0.03, 70.0),
        "k_hardening": (0.235, 235.0),
        "k_unloading": (0.305, 200.0),
    }.items():
        axes.annotate(text, place)
    axes.set(xlabel="deflection d [m]", ylabel="stress [kPa]")
    axes.legend(frameon=False)
    return figure


LAYERS = (
    ("cli, notebooks, files", ("studies, calibration", "plots, pages, tables"), "#dfe7ee"),
    ("Python: Simulation, Result", ("vehicle, barrier, scene", "signals, assessment"), "#dfe7ee"),
    ("bindings", ("validate, release the interpreter, views onto results",), "#eee6d8"),
    ("ensemble, simulation", ("the loop over steps",), "#e2ecdd"),
    ("control, record", ("step length, end of event", "histories, extremes"), "#e2ecdd"),
    ("step", ("half kick, drift, new forces, half kick",), "#e2ecdd"),
    ("contact", ("what a unit feels from a barrier",), "#e2ecdd"),
    ("scene", ("placement, obstacles, their map",), "#e2ecdd"),
    ("kernels", ("detect", "crush, indentation", "friction", "tyres", "impulses"), "#e2ecdd"),
    ("state", ("bodies, trusses, contacts, energies: all that changes",), "#e2ecdd"),
    ("model", ("vehicle, truss law, barrier, settings: constant",), "#e2ecdd"),
    ("base, geometry", ("numbers, tolerances, shapes, distances",), "#e2ecdd"),
)


def architecture() -> Figure:
    """Layers, the highest first; arrows point down."""
    figure = Figure(figsize=(7.6, 6.2), layout="constrained")
    axes = figure.add_subplot()
    axes.set_axis_off()
    axes.set(xlim=(0.0, 10.0), ylim=(-len(LAYERS), 0.4))
    for i, (name, parts, color) in enumerate(LAYERS):
        axes.text(0.1, -i - 0.42, name, va="center", weight="bold", fontsize=9)
        width = 6.9 / len(parts)
        for j, part in enumerate(parts):
            box = {"facecolor": color, "edgecolor": "0.55"}
            axes.add_patch(_rectangle((3.0 + j * width, -i - 0.8), width - 0.08, 0.74, **box))
            axes.text(3.0 + (j + 0.5) * width - 0.04, -i - 0.43, part, ha="center", va="center", fontsize=8)
    axes.annotate(
        "", (2.85, -len(LAYERS) + 0.1), (2.85, -0.1), arrowprops={"arrowstyle": "->", "color": "0.4"}
    )
    return figure


def _rectangle(place: tuple[float, float], width: float, height: float, **look: Any) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle(place, width, height, **look)


def work_precision() -> Figure:
    """Error against time of all cases."""
    figure = Figure(figsize=(7.2, 4.0), layout="constrained")
    axes = figure.add_subplot()
    for path in sorted((BENCH / "accuracy").glob("*.csv")):
        rows = [r for r in _rows(path) if r.get("kind") == "tolerance" and r["variant"] == "as given"]
        points = [(1e3 * float(r["run_time"]), 100.0 * float(r["error"])) for r in rows if r["error"]]
        points = [point for point in points if point[1] > 1e-6]
        if points:
            axes.loglog(*zip(*points, strict=True), ".-", label=path.stem.replace("_", " "))
    axes.set(xlabel="run time [ms]", ylabel="error of the worst metric [%]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7, ncols=2, frameon=False)
    return figure


def blind() -> Figure:
    """Travel of blind tests, computed over measured."""
    figure = Figure(figsize=(4.6, 4.2), layout="constrained")
    axes = figure.add_subplot()
    rows = [row for row in _rows(BENCH / "predictions/nhtsa_frontal.csv") if row["in_between_m"]]
    for kind in sorted({row["vehicle_class"] for row in rows}):
        points = [
            (float(r["measured_m"]), float(r["in_between_m"])) for r in rows if r["vehicle_class"] == kind
        ]
        axes.plot(*zip(*points, strict=True), "o", label=kind.replace("_", " "))
    _one_to_one(axes)
    axes.set(xlabel="travel, measured [m]", ylabel="travel, computed [m]")
    axes.legend(fontsize=7, frameon=False)
    return figure


def finite_element() -> Figure:
    """Crush and force of the finite-element runs, fitted and left out."""
    figure = Figure(figsize=(7.6, 3.8), layout="constrained")
    for axes, (column, unit, scale) in zip(
        figure.subplots(1, 2), (("crush", "m", 1.0), ("peak_force", "kN", 1e-3)), strict=True
    ):
        for name, mark in (("n", "o"), ("s", "s")):
            rows = _rows(VALIDATION / f"finite_element_{name}.csv")
            for what, fill in (("fitted", "full"), ("left out", "none")):
                kept = [r for r in rows if r["what"] == what]
                points = [(scale * float(r[f"{column}_measured"]), scale * float(r[column])) for r in kept]
                label = f"{name.upper()}, {what}"
                axes.plot(*zip(*points, strict=True), mark, fillstyle=fill, label=label)
        _one_to_one(axes)
        title = column.replace("_", " ")
        axes.set(xlabel=f"{title}, finite elements [{unit}]", ylabel=f"{title}, BIRM3D [{unit}]")
    axes.legend(fontsize=7, frameon=False)
    return figure


def posts() -> Figure:
    """Load of a single post against its diameter, and against its offset from the middle."""
    figure = Figure(figsize=(7.6, 3.8), layout="constrained")
    force, ratio = figure.subplots(1, 2)
    rows = _rows(VALIDATION / "posts.csv")
    for name in dict.fromkeys(row["vehicle"] for row in rows):
        own = [row for row in rows if row["vehicle"] == name]
        centered = [r for r in own if float(r["offset_share"]) == 0.0 and r["diameter"] != "0.354"]
        points = [(float(r["diameter"]), 1e-3 * float(r["force_50ms"])) for r in centered]
        force.plot(*zip(*points, strict=True), ".-", label=name.replace("_", " "))
        beside = [r for r in own if r["diameter"] == "0.354" and float(r["forward"]) > 0.0]
        shares = [(float(r["offset_share"]), abs(float(r["left"])) / float(r["forward"])) for r in beside]
        ratio.plot(*zip(*shares, strict=True), ".-")
    ratio.plot(0.5, 0.13, "k*", label="N, finite elements")
    force.set(xlabel="diameter [m]", ylabel="greatest mean force over 50 ms [kN]", ylim=(0.0, None))
    ratio.set(xlabel="offset / half width", ylabel="sideways / forward impulse", ylim=(0.0, 1.0))
    force.set_ylim(top=1.35 * force.get_ylim()[1])  # room for the legend
    force.legend(fontsize=7, ncols=2, loc="upper left", frameon=False)
    ratio.legend(fontsize=7, frameon=False)
    return figure


def _one_to_one(axes: Any) -> None:
    top = max(*axes.get_xlim(), *axes.get_ylim())
    axes.plot((0.0, top), (0.0, top), color="0.6", linewidth=0.8)


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def load_map() -> Figure:
    """Impulse and peak force on the cells of a wall, a car at 20 m/s and 25 degrees."""
    import birm3d

    car, wall = birm3d.Vehicle.preset("passenger_car"), birm3d.Barrier.rigid_wall(friction=0.3)
    return birm3d.Simulation(car, wall, 20.0, 25.0).run().load_map().plot()


def history_bands() -> Figure:
    """Deceleration and travel of 32 cars of the class at a wall, 35 mph."""
    import birm3d

    car, wall = birm3d.Vehicle.preset("passenger_car"), birm3d.Barrier.rigid_wall()
    crash = birm3d.Simulation(car, wall, impact_speed="35 mph")
    return birm3d.history_bands(birm3d.predict(crash, progress=False), progress=False).plot()


MADE: dict[str, Callable[[], Figure]] = {
    made.__name__: made
    for made in (
        sedan,
        tutorial,
        design_loads,
        load_map,
        history_bands,
        limits,
        truss_law,
        architecture,
        work_precision,
        blind,
        finite_element,
        posts,
    )
}


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Put pictures in the place of their marks."""

    def shown(match: re.Match[str]) -> str:
        name = match.group(1)
        if name not in MADE:
            _log.warning("%s: no picture %s", page.file.src_uri, name)
            return match.group(0)
        _used.add(name)
        url = posixpath.relpath(f"pictures/{name}.png", posixpath.dirname(page.url) or ".")
        return f'<img src="{url}" alt="{MADE[name].__doc__}">'

    return MARK.sub(shown, markdown)


def on_post_build(config: Any, **_: Any) -> None:
    """Draw the pictures that pages show."""
    folder = Path(config.site_dir, "pictures")
    folder.mkdir(parents=True, exist_ok=True)
    for name in sorted(_used):
        MADE[name]().savefig(folder / f"{name}.png", dpi=140)
    _used.clear()
