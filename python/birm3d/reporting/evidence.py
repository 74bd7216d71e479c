"""Given tests nearby, balances, verification and which phenomena the model includes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..assessment import Rating
from ..assessment.criteria import without_sign_of_zero
from ..base.plain_words import plain_words
from ..plotting.energies import plot_energies
from ..plotting.figure import new_figure
from ..plotting.style import prepare
from ..result.energy_balance import ENERGY_LIMIT, MOMENTUM_LIMIT
from ..result.event import outcome_words
from ..result.summary import shown_as
from .blocks import Block, Caution, Section, Table, Text
from .figures import figure
from .given_tests import Compared, GivenTest
from .numbers import percent
from .published_class import class_of
from .study_case import ROADSIDE, Case
from .tests_verdict import distance_past
from .uncertainty import computing_error
from .verdict_cautions import has_doubts

__all__ = ["balance_section", "beyond_tests", "validation_section"]

W179_ENERGY = 0.1
"""Greatest change of the total energy that NCHRP Web-Only Document 179 accepts, of that at the start."""

_FITTED_CRUSH = 0.75  # of the fronts of the presets, m
_STANDARDS = (
    "NCHRP Web-Only Document 179 and EN 16303 ask for verification (is it computed rightly?), validation "
    "(does it agree with tests?) and a list of phenomena (what does the model have?). Both were written for "
    "finite elements. CEN/TR 16303-3:2012 gives no rules for rigid-body codes and does not recommend them "
    "for certification: this dossier prepares and extends a test, it does not take its place."
)
_FITTED = (
    "Fitted: a number of the preset was fitted to this test, so that the row shows what the model can "
    "describe, not what it predicts. Computed with this version when the dossier was made, with the presets "
    "of the package, which may differ from the vehicle of this dossier."
)


def validation_section(case: Case) -> Section:
    """Return the nearest given tests and the phenomena."""
    blocks: list[Block] = [Text(_STANDARDS)]
    if case.tests:
        head = ("test", "like this scene in", "quantity", "measured", "computed", "error", "fitted")
        found = [row for one in case.tests for row in _rows(one)]
        blocks.append(Table("Given tests nearest to this scene", head, found, note=_FITTED))
        notes = {one.test.name: one.test.note for one in case.tests if one.test.note}
        if notes:
            caption = "Remarks on given tests"
            blocks.append(Table(caption, ("test", "remark"), list(notes.items())))
        sources = {one.test.name: one.test.source for one in case.tests}
        blocks.append(Table("Sources of given tests", ("test", "source"), list(sources.items())))
        missing = _not_alike(case.tests)
        if missing:
            blocks.append(Caution(missing))
    else:
        blocks.append(Text("There is no barrier: no given test is like this scene."))
    blocks.append(
        Table("Phenomena of the event", ("phenomenon", "in the model", "remark"), list(_phenomena(case)))
    )
    return Section("Validation", "validation", blocks)


def _rows(one: Compared) -> Iterator[tuple[str, ...]]:
    """Yield the row of a value; of containment a second one, of the class."""
    test = one.test
    alike = ", ".join(one.alike) if one.alike else "nothing"
    fitted = "yes" if test.fitted else "no"
    if one.rating is None:
        label, size, unit = shown_as(test.quantity)
        values = [f"{value / size:.3g} {unit}".strip() for value in (test.measured, one.computed)]
        yield test.name, alike, label, *values, f"{one.error:+.0%}", fitted
        return
    measured, computed = (
        "contained" if contained else "not contained" for contained in (test.measured, one.computed)
    )
    yield test.name, alike, "containment", measured, computed, "right" if one.right else "WRONG", fitted
    judged = "WRONG" if one.class_judged == "wrong" else str(one.class_judged)
    yield test.name, alike, "class or penetration", *_classes(test, one.rating), judged, fitted


def _classes(test: GivenTest, rating: Rating) -> tuple[str, str]:
    """Return the class that was published, with its penetration if there is one, and that computed."""
    own = class_of(rating)
    if rating.standard not in ROADSIDE:
        own = f"{own}, {distance_past(rating.penetration)}"
    if not test.published_class:
        return "–", own
    if test.penetration is None:
        return test.published_class, own
    limit = "at most " if test.penetration_kind == "limit" else ""
    return f"{test.published_class}, {limit}{test.penetration:g} m", own


def _not_alike(tests: list[Compared]) -> str:
    both = [one for one in tests if {"vehicle", "barrier"} <= set(one.alike)]
    if not both:
        return "No given test has both this kind of vehicle and this kind of barrier: the table extrapolates."
    if not any({"speed", "angle"} <= set(one.alike) for one in both):
        return "No given test with this vehicle and barrier has this speed and angle: the table extrapolates."
    return ""


def beyond_tests(case: Case) -> Iterator[tuple[str, str]]:
    """Yield question and answer of a run that crushes a vehicle deeper than any test that fronts rest on."""
    crush = case.result.metrics.get("dynamic_crush", 0.0)
    if crush > _FITTED_CRUSH:
        yield (
            "Is the crush within what was tested?",
            f"NO: greatest {crush:.2f} m, and fronts of presets are fitted to tests up to "
            f"{_FITTED_CRUSH:g} m; beyond it forces and travel are extrapolated",
        )


def _phenomena(case: Case) -> Iterator[tuple[str, str, str]]:
    result = case.result
    metrics, barrier = result.metrics, result.scene.barrier
    crush = metrics.get("dynamic_crush", 0.0)
    yield (
        "crush of the struck parts",
        "yes",
        f"greatest {crush:.2f} m here; fronts of presets are fitted to tests up to {_FITTED_CRUSH:g} m"
        f"{': beyond it this run extrapolates' if crush > _FITTED_CRUSH else ''}; sides and rears are orders "
        "of magnitude",
    )
    yield "engine stops before the cabin", "no", "one rigid body a unit"
    slides = result.scene.vehicle.slides
    if slides:
        told = f"slid by {metrics['bed_slip']:.2f} m here; the strength of its fixings is an estimate"
    elif result.scene.vehicle.has_bed:
        told = "fixed to the frame; Vehicle.with_sliding_bed() frees it"
    else:
        told = "the vehicle's file names no bed that could slide"
    yield "load bed slides on the frame", "yes" if slides else "no", told
    springs = result.scene.vehicle.has_springs
    told = (
        "springs, dampers and bump stops of wheels without mass"
        if springs
        else "wheels are fixed to the body"
    )
    yield "suspension", "yes" if springs else "no", told
    slips = result.scene.settings.tire_model == "slip"  # "skid" has no wheel planes
    free = slips and any(zone.steering_time is not None for zone in result.scene.vehicle.zones.values())
    told = (
        "front wheels follow their direction of travel; nobody steers" if free else "wheels are held straight"
    )
    yield "free steering", "yes" if free else "no", told
    yield "brakes of single wheels", "no", "wheels roll or slide, see the settings"
    gone = result.statistics.wheels_given_way
    told = f"; {gone} wheels were loaded beyond what they carry, and gave way" if gone else ""
    yield "wheels and parts that come off", "no", f"nothing leaves the vehicle{told}"
    yield "sheet metal that tears", "no", "the skin stays whole"
    if barrier is None:
        return
    if len(barrier.core.segments):
        over = metrics.get("max_overturning_ratio", 0.0)
        yield "segments that slide and turn on the ground", "yes", "friction on the ground"
        yield "segments that tip", "no", f"greatest overturning over restoring moment {over:.2f}"
    elif barrier.core.yielding_posts:
        yield "posts that yield at the foot or in the foundation", "yes", "constant plastic moment"
        yield "posts that buckle, tear or spring back", "no", "forces and deflections assume that they do not"
    else:
        yield (
            "barrier that bends, breaks or moves in its foundation",
            "no",
            ("forces are upper bounds where it would, penetration a lower bound"),
        )
    yield "occupants, belts, bags", "no", "occupant risk follows from the motion of the vehicle"


def balance_section(case: Case) -> Section:
    """Return energy and momentum balance and the criteria of verification."""
    result = case.result
    drawing = new_figure(9.0, 4.2)
    axes = drawing.add_subplot()
    prepare(axes)
    plot_energies(axes, result)
    axes.set_xlabel("time [ms]")
    blocks: list[Block] = [
        Table(
            "Verification: criteria in the form of NCHRP W179 and EN 16303",
            ("criterion", "value", "limit", "verdict"),
            list(_criteria(case)),
        ),
        figure(drawing, "Energy over time"),
        Table(
            "Energy balance",
            ("term", "at the start [kJ]", "at the end [kJ]", "change, of the initial kinetic energy"),
            list(_energies(case)),
            numbers=True,
        ),
        Table(
            "Momentum balance of the whole run",
            ("impulse of", "x [kN s]", "y [kN s]", "z [kN s]"),
            list(_momenta(case)),
            note="World axes, z up. Forces are means over their intervals, so that the sum is exact.",
            numbers=True,
        ),
    ]
    return Section("Energy and momentum balance", "balance", blocks)


def _criteria(case: Case) -> Iterator[tuple[str, str, str, str]]:
    result = case.result
    metrics = result.metrics
    energy, momentum = metrics["energy_residual"], metrics["momentum_residual"]

    def verdict(good: bool) -> str:
        return "pass" if good else "FAIL"

    yield (
        "total energy changes by less than 10 % (W179)",
        percent(energy),
        "10 %",
        verdict(energy < W179_ENERGY),
    )
    own = f"{ENERGY_LIMIT:.1%}"
    yield "total energy, this program's own limit", percent(energy), own, verdict(energy <= ENERGY_LIMIT)
    yield (
        "hourglass energy, of the total and of each part (W179)",
        "none",
        "5 %, 10 %",
        "not applicable: there are no elements with reduced integration",
    )
    yield (
        "mass added by scaling, of the total and of each part (W179)",
        "0 kg",
        "5 %, 10 %",
        "not applicable: no mass is added, the skin has none",
    )
    yield (
        "shooting nodes, negative volumes (W179)",
        "none",
        "none",
        "not applicable: nodes of the skin have no mass",
    )
    limit = f"{MOMENTUM_LIMIT:.4%} of the greatest force"
    yield (
        "momentum: m a is the sum of the forces, each row",
        percent(momentum),
        limit,
        verdict(momentum <= MOMENTUM_LIMIT),
    )
    worst = max((error for *_, error in computing_error(case) if error is not None), default=0.0)
    yield "headline numbers with a hundredth of the tolerance", percent(worst), "1 %", verdict(worst <= 0.01)
    yield "the outcome is decided", outcome_words(result.outcome), "", verdict(result.outcome != "undecided")
    told = len(case.warnings)
    doubts = "see the cautions of the verdict: ratings have doubts" if has_doubts(case) else "pass"
    yield "warnings of the run", str(told), "none", doubts if told == 0 else "see the section on warnings"


def _energies(case: Case) -> Iterator[tuple[str, ...]]:
    start = float(case.result.energy["kinetic"][0])
    for name, values in case.result.energy.items():
        first, last = float(values[0]), float(values[-1])
        share = f"{(last - first) / start + 0.0:+.3%}".replace("-0.000%", "+0.000%") if start > 0.0 else "–"
        yield (
            plain_words(name),
            without_sign_of_zero(f"{first / 1e3:,.2f}"),
            without_sign_of_zero(f"{last / 1e3:,.2f}"),
            share,
        )


def _momenta(case: Case) -> Iterator[tuple[str, ...]]:
    """Yield the impulses, their sum, the change of momentum, and the difference."""
    result = case.result
    vehicle, gravity = result.scene.vehicle, result.scene.settings.gravity
    interval = np.diff(result.time)[:, None]
    duration = float(result.time[-1] - result.time[0])
    up = np.array([0.0, 0.0, 1.0])
    terms = {
        "barrier": (result.barrier_force[1:] * interval).sum(axis=0),
        "ground on tyres, normal": float((result.tire_reaction[1:] * interval).sum()) * up,
        "ground on tyres, friction": (result.tire_friction_force[1:] * interval).sum(axis=0),
        "ground on the body": (result.ground_force[1:] * interval).sum(axis=0),
        "weight": -vehicle.mass * gravity * duration * up,
    }
    total = np.sum(list(terms.values()), axis=0)
    change = np.sum(
        [
            unit.mass * (result.unit(i).velocity[-1] - result.unit(i).velocity[0])
            for i, unit in enumerate(vehicle.units)
        ],
        axis=0,
    )
    rows = {**terms, "sum of impulses": total, "change of momentum": change}
    for name, value in rows.items():
        yield name, *(without_sign_of_zero(f"{x / 1e3:,.3f}") for x in value)
    yield "difference", *(f"{x / 1e3:.1e}" for x in total - change)
