"""The page: what is in it, put into the template."""

from __future__ import annotations

import json
from collections.abc import Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from .. import units
from ..barrier.kinds import RigidWall
from ..barrier.text import barrier_text
from ..io.atomic_write import whole_file
from ..result.crush_profile import Side, crushed_sides, side_words
from ..result.element_loads import touched_elements
from ..result.event import outcome_words
from ..result.metrics import METRIC_UNITS
from ..result.report import END_REASONS
from ..result.summary import ELEMENT_COLUMNS, element_rows, outcome_rows
from ..scene.text import scene_text
from ..vehicle.title import vehicle_text
from .notebook import figure_html
from .page_data import page_data
from .scene_cards import turned_rows

if TYPE_CHECKING:
    from ..barrier.barrier import Barrier
    from ..result.result import Result
    from ..scene.scene import Scene

__all__ = ["write_html"]

# Above these the balances of a run are worth a look.
_ENERGY, _MOMENTUM = 5e-3, 1e-9


def write_html(result: Result, path: str | Path, *, frames: int = 61, crush: bool = True) -> None:
    """Write one page that needs no network: scene, outcome, plan view with a slider, histories, crush.

    Histories are after their channel frequency class (SAE J211-1).

    Parameters
    ----------
    path
        Of the file.
    frames
        Number of instants of the plan view's slider, >= 2.
    crush
        Whether it has pictures of the residual crush; without them it is written sooner.

    Raises
    ------
    ImportError
        Without plotly.
    ValueError
        If there are fewer than 2 frames or more than rows, or the path is a folder or lies in none.
    """
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as error:
        raise ImportError("write_html() needs plotly: pip install 'birm3d[html]'") from error
    # Inside a script element no text may end it.
    content = page_data(result, frames)
    data = json.dumps(content, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    here = files(__package__)
    page = here.joinpath("page.html").read_text(encoding="utf-8")
    parts = {
        "TITLE": escape(scene_text(result.scene)),
        "VERSION": escape(result.version),
        "SCENE": _table(("scene", ""), _scene_rows(result)),
        "OUTCOME": _table(("outcome", "value", "unit"), outcome_rows(result)),
        "CHECKS": _table(("check", "", "limit", "value"), _check_rows(result)),
        "ELEMENTS": _element_table(result),
        "LOADMAP": _load_map(result),
        "METRICS": _table(("metric", "value", "unit"), _metric_rows(result)),
        "CRUSH": _crush_section(result) if crush else "",
        "REPORT": escape(result.report()),
        "ROWS": "" if content["every"] == 1 else f"One row in {content['every']} is shown.",
        "REPLAY": here.joinpath("replay.js").read_text(encoding="utf-8"),
        "REPLAYSTYLE": here.joinpath("replay.css").read_text(encoding="utf-8"),
        "SCRIPT": here.joinpath("page.js").read_text(encoding="utf-8"),
        "DATA": data,
        "PLOTLY": get_plotlyjs(),
    }
    # One pass from left to right: what is put in is not looked at again.
    head, *rest = page.split("<!--")
    text = [head]
    for piece in rest:
        name, _, tail = piece.partition("-->")
        text += [parts[name], tail]
    with whole_file(path) as part:
        part.write_text("".join(text), encoding="utf-8")


def _table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    def line(cells: tuple[str, ...], tag: str) -> str:
        text = [cell for cell in cells if cell]
        if len(cells) == 3 and not cells[0] and len(text) == 1:
            # A remark to the row above, which beside numbers would leave their names no room on a phone.
            return f'<tr><td colspan="3">{escape(text[0])}</td></tr>'
        return "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    body = "".join(line(row, "td") for row in rows)
    return f"<table><thead>{line(head, 'th')}</thead><tbody>{body}</tbody></table>"


def _element_table(result: Result) -> str:
    rows = element_rows(result)
    if not rows:
        return "<p>None was touched.</p>"
    return f'<div class="wide">{_table(ELEMENT_COLUMNS, rows)}</div>'


def _load_map(result: Result) -> str:
    """Return the picture of the load on a rigid wall, of other barriers nothing."""
    if not isinstance(result.scene.barrier, RigidWall) or not touched_elements(result.element_loads):
        return ""
    picture = figure_html(result.load_map().plot(), "load on the wall by cell", dpi=90.0)
    return f"<h2>Load on the wall by cell</h2>{picture}"


def _scene_rows(result: Result) -> list[tuple[str, ...]]:
    scene, settings = result.scene, result.scene.settings
    vehicle = scene.vehicle
    steps = (
        f"fixed, {settings.time_step:g} s"
        if settings.time_step
        else f"adaptive, tolerance {settings.tolerance:g}"
    )
    return [
        ("vehicle", f"{vehicle_text(vehicle, 1)}, {vehicle.n_nodes:,} shell nodes"),
        ("barrier", _barrier(scene.barrier)),
        ("impact speed", f"{scene.impact_speed:.3f} m/s ({scene.impact_speed / units.mph:.1f} mph)"),
        ("impact angle", f"{scene.impact_angle:g}° from the barrier's line"),
        _aim(scene),
        *turned_rows(scene),
        ("time steps", steps),
        ("contact, tyres", f"{settings.contact_model}, {settings.tire_model}"),
        ("ended", f"at {result.time[-1]:.4f} s: {END_REASONS[result.end_reason]}"),
        ("state hash", f"{result.state_hash:016x}"),
    ]


def _aim(scene: Scene) -> tuple[str, str]:
    if scene.overlap is None:
        return "impact offset", f"{scene.impact_offset:g} m"
    return "overlap", f"{100.0 * scene.overlap:g} % of the width, {scene.overlap_side} side"


def _barrier(barrier: Barrier | None) -> str:
    """Return what the barrier is, its friction, and where it stands if that is not the usual place."""
    if barrier is None:
        return "none"
    given = [barrier_text(barrier), f"friction {barrier.friction:g}"]
    if any(barrier.origin):
        given.append("origin " + ", ".join(f"{x:g}" for x in barrier.origin) + " m")
    if barrier.heading:
        given.append(f"heading {barrier.heading:g}°")
    return ", ".join(given)


def _check_rows(result: Result) -> list[tuple[str, ...]]:
    metrics = result.metrics
    rows: list[tuple[str, ...]] = []
    for name, label, limit in (
        ("energy_residual", "energy balance closes, of the initial kinetic energy", _ENERGY),
        ("momentum_residual", "momentum balance closes, of the greatest force", _MOMENTUM),
    ):
        good = metrics[name] <= limit
        rows.append((label, "✓ yes" if good else "✗ no", f"{limit:g}", f"{metrics[name]:.1e}"))
    decided = result.outcome != "undecided"
    rows.append(("the outcome is decided", "✓ yes" if decided else "✗ no", "", outcome_words(result.outcome)))
    return rows


def _metric_rows(result: Result) -> list[tuple[str, ...]]:
    return [(name, f"{value:.6g}", METRIC_UNITS.get(name, "")) for name, value in result.metrics.items()]


def _crush_section(result: Result) -> str:
    units = range(len(result.scene.vehicle.units))
    pictures = "".join(
        _crush_picture(result, side, unit) for unit in units for side in crushed_sides(result, unit=unit)
    )
    return f"<h2>Residual crush</h2>\n{pictures or '<p>None.</p>'}"


def _crush_picture(result: Result, side: Side, unit: int) -> str:
    return figure_html(
        result.plot_crush(side, unit=unit), f"residual crush of the {side_words(side)}", dpi=90.0
    )
