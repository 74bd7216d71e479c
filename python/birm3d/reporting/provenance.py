"""What was left out, warnings, versions, and how to run it again."""

from __future__ import annotations

import dataclasses
import hashlib

from ..base.plain_words import plain_words
from ..io.made_with import facts_text, platform_facts
from ..result.metrics import METRIC_UNITS
from .blocks import Block, Items, Listing, Section, Table, Text
from .study_case import Case
from .verdict_cautions import has_doubts

__all__ = ["CAPSULE", "metrics_section", "omitted_section", "provenance_section", "warning_section"]

CAPSULE = "run.birm3d"


def omitted_section(case: Case) -> Section:
    """Return the report of the run: what was computed and what was left out."""
    return Section("What was computed and what was left out", "omitted", [Listing(case.run.report())])


def warning_section(case: Case) -> Section:
    """Return the warnings of the run."""
    blocks: list[Block] = (
        [Items(items=case.warnings)] if case.warnings else [Text("The run gave no warnings.")]
    )
    if has_doubts(case):
        blocks.append(Text("Ratings have doubts: see the cautions of the verdict."))
    return Section("Warnings", "warnings", blocks)


def provenance_section(case: Case, capsule: bytes) -> Section:
    """Return versions, platform, settings, state hash and the capsule."""
    result = case.result
    settings = result.scene.settings
    rows = [
        (plain_words(field.name), _plain(getattr(settings, field.name)))
        for field in dataclasses.fields(settings)
    ]
    digest = hashlib.blake2b(capsule, digest_size=16).hexdigest()
    made = platform_facts()
    blocks: list[Block] = [
        Text(
            "The capsule beside this page holds scene, vehicle, settings and histories by value. "
            f"`birm3d rerun {CAPSULE}` runs it again and compares the state hash: the same bits, or by how "
            "much the metrics differ."
        ),
        Items(links=((f"Capsule, {len(capsule) / 1024:,.0f} KB", CAPSULE),)),
        Table(
            "Reproduction",
            ("", "value"),
            [
                ("state hash", f"{result.state_hash:016x}"),
                ("run computed with", facts_text(result.made_with)),
                ("dossier made with", ", ".join(f"{name} {value}" for name, value in made.items())),
                ("steps", f"{result.statistics.steps:,}, {result.statistics.rejected:,} redone"),
                ("capsule's BLAKE2b", digest),
            ],
        ),
        Table("Settings", ("setting", "value"), rows, note="SI."),
    ]
    return Section("Versions and reproduction", "reproduction", blocks)


def _plain(value: object) -> str:
    if value is None:
        return "by the program's rule"
    return f"{value:g}" if isinstance(value, float) else str(value)


def metrics_section(case: Case) -> Section:
    """Return all metrics."""
    rows = [(name, f"{value:.6g}", METRIC_UNITS.get(name, "")) for name, value in case.result.metrics.items()]
    table = Table("All metrics, SI and degrees", ("metric", "value", "unit"), rows, numbers=True)
    return Section("Appendix: all metrics", "metrics", [table, Items(links=(("As a file", "metrics.csv"),))])
