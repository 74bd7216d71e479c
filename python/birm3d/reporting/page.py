"""The page: sections in the order in which a reviewer reads them, laid out by a template."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from importlib.resources import files as resources
from typing import Any

from ..html_page.replay import replay_data
from ..scene.text import scene_text
from .blocks import Block, Items, Replay, Section, Text
from .evidence import balance_section, validation_section
from .figures import figure
from .loads import load_section
from .provenance import (
    CAPSULE,
    metrics_section,
    omitted_section,
    provenance_section,
    warning_section,
)
from .scene_part import scene_section, vehicle_section
from .study_case import Case
from .uncertainty import uncertainty_section
from .verdict import risk_section, verdict_section

__all__ = ["page"]

_PERCENT = re.compile(r"(\d) ?%")
_VERDICT = re.compile(r"(pass|right)\b|(FAIL|WRONG|NOT)\b")


def page(case: Case, title: str | None, facts: Mapping[str, str], beside: Mapping[str, bytes]) -> str:
    """Return the page; `beside` are the files that will stand beside it."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    sections = [
        verdict_section(case),
        scene_section(case),
        _motion_section(case, "histories.html" in beside),
        load_section(case),
        risk_section(case),
        uncertainty_section(case),
        validation_section(case),
        balance_section(case),
        vehicle_section(case),
        omitted_section(case),
        warning_section(case),
        provenance_section(case, beside[CAPSULE]),
        metrics_section(case),
    ]
    environment = Environment(
        loader=PackageLoader("birm3d.reporting", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(mark=_mark, tidy=_tidy)
    assets = resources("birm3d.html_page")
    result = case.result
    return environment.get_template("dossier.html").render(
        title=title if title is not None else f"Impact: {scene_text(result.scene)}",
        scene="" if title is None else scene_text(result.scene),
        facts={name: value for name, value in facts.items() if value},
        version=result.version,
        state_hash=f"{result.state_hash:016x}",
        sections=sections,
        replay=_json(next(b.data for s in sections for b in s.blocks if isinstance(b, Replay))),
        replay_script=assets.joinpath("replay.js").read_text(encoding="utf-8"),
        replay_style=assets.joinpath("replay.css").read_text(encoding="utf-8"),
    )


def _motion_section(case: Case, interactive: bool) -> Section:
    result = case.result
    blocks: list[Block] = [
        Replay(
            "Replay, colours show how far the skin has moved on the body, in any direction",
            replay_data(result, len(result.frames or ()) or 60),
        ),
        figure(result.plot_histories(), "Histories; filtered channels state their class (SAE J211-1)"),
    ]
    crush = _crush(case)
    blocks += crush if crush else [Text("Nothing of the vehicle stays crushed.")]
    if interactive:
        blocks.append(Items(links=(("Histories to zoom into and read values from", "histories.html"),)))
    return Section("Motion and crush", "motion", blocks)


def _crush(case: Case) -> list[Block]:
    from ..result.crush_profile import crushed_sides, side_words

    result = case.result
    units = range(len(result.scene.vehicle.units))
    return [
        figure(result.plot_crush(side, unit=unit), f"Residual crush of the {side_words(side)}", raster=True)
        for unit in units
        for side in crushed_sides(result, unit=unit)
    ]


def _json(data: dict[str, Any]) -> str:
    """Return JSON that no script element ends in."""
    return json.dumps(data, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")


def _tidy(text: str) -> str:
    """Return a text with the signs of print; no line begins with a sign of percent."""
    text = text.replace("+-", "±").replace("<=", "≤").replace(">=", "≥").replace("^2", "²")
    return _PERCENT.sub("\\1\u00a0%", text)


def _mark(cell: str) -> str:
    """Return the class of a cell with a verdict; a verdict is a word of its own."""
    found = _VERDICT.match(cell)
    return "" if found is None else "good" if found[1] else "bad"
