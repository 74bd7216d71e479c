"""Answers on the barrier: whether it kept the vehicle, how far it gives way, and what has to hold it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .. import _core
from ..assessment import DesignLoad, Rating
from ..assessment.doubts import doubts_of_run
from ..result.element_loads import touched_elements
from ..result.event import gets_past
from ..result.result import Result
from ..result.tipping import RATIO, TIPPING_LIMIT
from .class_bands import band_of
from .static_force import band_of_design, made_by
from .study_case import Case

__all__ = ["foundation_answer", "kept_words", "movement_answer"]

_LEANS = ("post_tilt", "fastest_rise")  # doubts in what posts that lean do
_TIPS = ": it would begin to tip, which is not computed, see the cautions below"


def kept_words(result: Result, rating: Rating) -> str:
    """Return whether the vehicle was contained; of one that got past and does not go on, what it did."""
    if not rating.contained:
        return "NOT contained"
    if not gets_past(result):
        return "contained"
    if float(np.linalg.norm(result.final_velocity)) < _core.coasting_speed:
        return "came to rest behind the barrier"
    return "got past the barrier, and does not go on behind it"


def movement_answer(case: Case) -> Iterator[tuple[str, str]]:
    """Yield how far a barrier gives way that yields or stands free, with the doubt in it."""
    metrics = case.result.metrics
    if "barrier_deflection" not in metrics:
        return
    most, stays = metrics["barrier_deflection"], metrics["residual_barrier_deflection"]
    far = f"by up to {most:.2f} m away from traffic, {stays:.2f} m of it stays"
    band = _band(case, "barrier_deflection", ".2f", "m")
    if "post_tilt" in metrics:
        tilt = _band(case, "post_tilt", ".0f", "degrees")
        text = f"posts lean by up to {metrics['post_tilt']:.0f} degrees{tilt}; their tops move {far}{band}"
        if any(doubt.kind in _LEANS for doubt in doubts_of_run(case.result)):
            text += "; do not rely on the outcome, see the cautions below"
    else:
        text = f"segments move {far}{band}"
        if RATIO in metrics:
            ratio, of_class = metrics[RATIO], _band(case, RATIO, ".3g", "")
            text += f"; the overturning moment of one is up to {ratio:.3g} times its restoring one{of_class}"
            text += _TIPS if ratio > TIPPING_LIMIT else ""
    yield "How far does the barrier give way?", text


def _band(case: Case, name: str, form: str, unit: str) -> str:
    if isinstance(case.bands, str) or name not in case.bands.prediction.low:
        return ""
    return f" (80 % of the class: {band_of(case.bands, name, 1.0, form)}{f' {unit}' if unit else ''})"


def foundation_answer(case: Case) -> Iterator[tuple[str, str]]:
    """Yield the load on the foundation, or of segments that stand free the friction on the ground."""
    result = case.result
    barrier = result.scene.barrier
    loads = touched_elements(result.element_loads)
    free = getattr(barrier, "free_standing", None)
    if barrier is not None and free is not None:
        weight = max(segment.mass for segment in barrier.core.segments) * result.scene.settings.gravity
        friction = free.ground_friction * weight
        yield (
            "What holds the segments in their place?",
            "friction on the ground is all there is, they have no foundation: "
            f"{free.ground_friction:g} times the weight of {weight / 1e3:,.1f} kN, {friction / 1e3:,.1f} kN "
            "for each segment, and more only while the vehicle presses it down",
        )
    elif isinstance(case.design_loads, DesignLoad) and loads:
        row = case.design_loads.governing
        height = (
            f" at {row.design['height']:.2f} m" if row.design["height"] > 0.0 else ", mostly from its weight"
        )
        alone = "this run alone, " if case.study is not None and len(case.design_loads.scenes) == 1 else ""
        yield (
            "What does its foundation have to carry?",
            f"{alone}{row.name}: {'design with an ' if row.band else ''}equivalent static force "
            f"{row.design['equivalent_static_force'] / 1e3:,.0f} kN{height}, "
            f"moment at the foot {row.design['moment'] / 1e3:,.0f} kN m, "
            f"{made_by(case.design_loads)}{band_of_design(row)}",
        )
