"""The page on the truck: what was computed beside the finite-element runs, before and after the fit."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import birm3d
import truck_pair
import truck_preset_page
from truck_front import NUMBERS, Number, vehicle_with
from truck_runs import POST_DIAMETER, START, figures, runs, scene
from truck_tables import HEAD, SCORE_HEAD, Row, cells, computed, count, score, table

if TYPE_CHECKING:
    from fit_truck import Fit

PAGE = Path(__file__).with_name("truck.md")


def pitches(vehicle: birm3d.Vehicle) -> list[list[str]]:
    """Greatest pitch with front wheels that hold, with all of the friction, and with both."""
    front = {n: zone for n, zone in vehicle.zones.items() if zone.friction_share is not None}
    rough = {n: dataclasses.replace(zone, friction_share=1.0) for n, zone in front.items()}
    held = {"tire_front": dataclasses.replace(vehicle.zones["tire_front"], breakaway=1e9)}
    variants = [vehicle.with_zones(zones) for zones in ({}, held, rough, {**held, **rough})]
    lines = []
    for run in runs().values():
        several = [row.own.pitch for own in variants for row in computed(own, [run])]
        lines.append([run.name, f"{run.pitch:.1f}", *(f"{pitch:.1f}" for pitch in several)])
    return lines


def diameters(vehicle: birm3d.Vehicle) -> list[list[str]]:
    """Impulses on an outer post of the row of three against diameter; its inner face stays where it is."""
    run = runs()["bollards3_50"]
    inner = run.posts[-1] - 0.5 * POST_DIAMETER
    lines = []
    for diameter in (0.1, 0.2, 0.32, 0.45, 0.6):
        outer = inner + 0.5 * diameter
        row = dataclasses.replace(run, posts=(-outer, 0.0, outer))
        several = [
            figures(scene(own, row, diameter=diameter).run())
            for own in (vehicle, vehicle.with_indentation_length(0.0))
        ]
        left = [1e-3 * own.impulse[-1] for own in several]
        lines.append([f"{diameter:g}", *(f"{value:.1f}" for pair in left for value in pair)])
    return lines


def page(fits: Sequence[Fit]) -> str:
    """The page, Markdown, of the fits of every variant: to all runs, and with each run left out."""
    fitted = fits[0]
    start = vehicle_with({n.name: n.start for n in NUMBERS}, birm3d.Vehicle.from_file(START))
    after = computed(fitted.vehicle)
    lines = [INTRODUCTION, "", "## The truck of the runs: thirteen numbers fitted to all runs together"]
    for title, rows in ((BEFORE, computed(start)), (AFTER, after)):
        core = sum(row.own.core_contact for row in rows)
        lines += ["", title, "", *table(HEAD, [cells(row) for row in rows]), ""]
        lines += [f"Met: {count(rows)}. Rigid core met: {core} times."]
    lines += _left_out(fits)
    band = [one for one in fits[1:] if one.variant == fitted.variant]
    lines += ["", "## What was fitted", "", LIKELY, "", *_numbers(fitted, band)]
    lines += ["", "## What one rigid body can not meet", "", *_parts(after)]
    lines += ["", *truck_pair.section(fitted.vehicle)]
    lines += ["", "## What holds the nose up, and posts beside the bumper", "", PITCH]
    lines += ["", *table(PITCH_HEAD, pitches(fitted.vehicle)), "", POSTS, ""]
    lines += [*table(DIAMETER_HEAD, diameters(fitted.vehicle)), ""]
    lines += ["## The same truck with a bed that slides", "", *_with_sliding_bed(fits), ""]
    return "\n".join([*lines, *truck_preset_page.sections(), ""])


def _left_out(fits: Sequence[Fit]) -> list[str]:
    """Each run left out: those of the first variant as a table, of every variant their mean errors."""
    known: dict[str, list[Row]] = {}
    for one in fits:
        if one.left_out:
            known.setdefault(one.variant, []).extend(computed(one.vehicle, [runs()[one.left_out]]))
    lines = ["", "## Each run left out in turn", "", LEFT_OUT, ""]
    lines += [*table(HEAD, [cells(row) for row in known[fits[0].variant]]), ""]
    scores = []
    for one in fits:
        if not one.left_out:
            scores.append([one.variant, "left out", *score(known[one.variant])])
            scores.append([one.variant, "fitted to all", *score(computed(one.vehicle))])
    return [*lines, *table(("front", "runs", *SCORE_HEAD), scores)]


def _numbers(fit: Fit, band: Sequence[Fit]) -> list[str]:
    def of(number: Number) -> list[str]:
        others = [own.values[number.name] for own in band]
        spread = f"{min(others):.3g} to {max(others):.3g}" if others else ""
        found = f"{fit.values[number.name]:.3g}"
        return [
            number.name,
            number.unit,
            found,
            spread,
            f"{number.likely[0]:.3g} to {number.likely[1]:.3g}",
            f"{number.lower:.3g} to {number.upper:.3g}",
            number.why,
        ]

    head = ("number", "unit", "found", "with a run left out", "likely", "bounds", "why")
    return table(head, [of(number) for number in NUMBERS])


def _parts(rows: Sequence[Row]) -> list[str]:
    head = (
        "run",
        "engine lags [kN s]",
        "bed leads [kN s]",
        "bed slips [m]",
        "front axle goes back [m]",
        "barrier's impulse up on the vehicle [kN s], computed (run)",
        "ground's, run [kN s]",
        "height of the force, run [m]",
        "impulse forward, each post or wall [kN s]",
        "friction at the barrier (all contacts, run) [% of the energy]",
    )
    lines = []
    for row in rows:
        run, own = row.run, row.own
        forward = zip(1e-3 * own.impulse[:, 0], 1e-3 * run.impulse[:, 0], strict=True)
        lines.append(
            [
                run.name,
                f"{1e-3 * run.engine_lags:.1f}",
                f"{1e-3 * run.bed_leads:.1f}",
                f"{run.bed_slip:.2f}",
                f"{run.axle_back:.2f}",
                f"{1e-3 * own.up:.1f} ({1e-3 * run.barrier_up:.1f})",
                f"{1e-3 * run.ground_up:.1f}",
                f"{run.action_height:.2f}",
                "; ".join(f"{new:.0f} ({old:.0f})" for new, old in forward),
                f"{100 * own.friction:.0f} ({100 * run.contact_share:.0f})",
            ]
        )
    named = {row.run.name: row for row in rows}
    right, left = 1e-3 * named["bollards2_50_offset"].own.impulse
    told = READING.format(
        travel=f"{100 * named['wall00_50'].errors['travel']:+.0f} %",
        jam=f"{100 * named['bollards3_50'].errors['force']:+.0f} %",
        forward=f"{left[0]:.0f} and {right[0]:.0f}",
        sideways=f"{abs(right[1]):.0f} and {abs(left[1]):.0f}",
    )
    return [PARTS, "", *table(head, lines), "", told]


def _with_sliding_bed(fits: Sequence[Fit]) -> list[str]:
    """The fitted front with a bed that slides, and that front fitted with such a bed."""
    lines = [SLIDING]
    slides = next(one for one in fits if not one.left_out and len(one.vehicle.units) > 1)
    head = (*HEAD, "slip of the bed's front edge [m]", "travel of the chassis [m]")
    for title, vehicle in (
        ("The vehicle's file, `with_sliding_bed()`:", fits[0].vehicle.with_sliding_bed()),
        ("The thirteen numbers fitted to the runs with such a bed:", slides.vehicle),
    ):
        rows = computed(vehicle)
        parts = [
            [*cells(row), f"{row.own.slip:.2f} ({slip:.2f})", f"{row.own.chassis_travel:.2f}"]
            for row, slip in zip(rows, FRONT_SLIPS, strict=True)
        ]
        lines += ["", title, "", *table(head, parts), "", f"Met: {count(rows)}."]
    return lines


# Greatest slip of the bed's front edge against the frame's rear end in the runs, along the ground [m]:
# from the curves bed_edge_x and rail_rear_x.
FRONT_SLIPS = (0.09, 0.64, 0.00, 0.06, 0.08)

SLIDING = """Chassis of 2,939 kg and bed of 3,871 kg, `with_sliding_bed()`. The force that holds the bed
against its slip is from the run at the wall at 50 mph: 670 kN until the bolts fail after 0.09 m (table of
parts: twelve of 50 kN, friction 0.2), then 220 kN. From 0.3 m on it rises to 1.15 MN, as the bed crushes the
cab. So that run is no prediction here, not even where it is left out. The model has no contact between cab
and bed. Travel is that of the mass centre of both; `max_displacement` of a result is the chassis's. A run
takes 1.5 to 1.8 times as long. Masses, offsets and angles work as with one body. The file has one body: a
front fitted with a bed meets fewer marks."""

PITCH_HEAD = (
    "greatest pitch [deg]",
    "run",
    "computed",
    "with front wheels that hold",
    "with all of the friction",
    "with both",
)

DIAMETER_HEAD = (
    "diameter of the posts [m]",
    "forward on an outer post [kN s]",
    "sideways",
    "forward, without indentations",
    "sideways, without indentations",
)

POSTS = """The outer posts of the row of three, inner faces at 1.04 m, where the bumper ends at 1.125 m (run:
0.4 forward, 1.2 sideways). Only indentations push them. Of a thinner post more is before the bumper."""

BEFORE = "Before the fit, each number at the middle of what is likely (see below):"
AFTER = "Fitted, `tests/data/finite_element/fitted_truck.toml`:"

INTRODUCTION = """# A truck at walls and bollards, beside finite-element runs

Written by `python tests/validation/fit_truck.py --save`. The runs were made for this project with
OpenRadioss on a generic truck of 6,810 kg: a finite-element code's answer for a plausible truck, not a test.
`tests/data/finite_element/truck_runs.csv` says what each number is. In brackets: the run. Bold: not within
12 % of the travel, 15 % of the force, 20 kN s sideways on a post, 5 deg of pitch.

The marks are targets. Repeats of a run differ by 5 % in travel and in force over 50 ms. Pitch is the
greatest until a run ends, 0.12 to 0.25 s after the touch. Then the pitch of the computed trucks still
grows, except for the preset at the wall at 25 deg. Overturning moments of the two files, fitted and preset,
are in [the page of all tests](README.md#finite-element-truck-walls-and-bollards), with travel and force."""

LEFT_OUT = """Fitted to the four others, from the middle of what is likely. Only the wall at 25 deg tells of
the tyres, only posts of the indentation length, only the row of three of the tail of the middle. Zones,
depths of envelopes, what a front wheel carries, what is likely, and the standard deviations of the fit were
settled with all runs in view: wider and other ranges met 9 to 11 of 17 left out. So these rows are no blind
predictions. An earlier fit of eleven numbers, with starts that were chosen by all runs, met 11 of 17: mean
errors 12 % in travel, 18 % in force, 21 kN s sideways."""

LIKELY = """Likely is what the table of parts, sections, sheet strengths, and vehicles N and S say: plus and
minus two standard deviations. Bounds are wider. Fits start from the middle."""

PARTS = """The vehicle is one rigid body. In the runs the engine stops in the barrier while the frame goes on,
the bed slides on the frame, and the front axle is pushed back under it. From the runs:"""

READING = """- **Engine.** The momentum that it lacks is taken from it in 5 to 15 ms: one to two meganewtons
  more for so long. The force over 50 ms has it, the peak does not: the fitted envelope spreads the blow over
  the depth.
- **Bed.** At the wall at 50 mph the frame has stopped at 70 ms, and the bed still has a third of
  the truck's momentum. It slides on and brings it to the wall by 140 ms, at a third of the force of
  the first half. One body stops as a whole: travel {travel}. The slips of the table are those of the bed's
  rear end over the frame's, along the ground. At the wall at 50 mph the bed tips by 41 degrees after its
  bolts have failed; its front edge slides by 0.64 m.
- **Row of three.** Bed, folded cab and engine jam on the post in the middle at 110 ms, with 3.4 MN for 15 ms.
  That is the greatest force over 50 ms. One body has the tail of the middle for it: force {jam}.
- **Posts at a rail and beside it.** The run shares the load evenly between the two posts of the offset pair,
  as its frame bends sideways. The computed post at the rail and the engine takes more than the other:
  {forward} kN s forward.
- **Two posts at a frame.** In the run the front of the frame bends, and jams between the two posts: 62 and
  53 kN s sideways. The computed front is crushed straight back, and nothing is squeezed between the posts:
  {sideways} kN s. This is the mark of posts that is not met."""

PITCH = """The force acts below the mass centre, at about the height that the runs have. In the runs front
springs and hangers give way, and folds of the front stay where they touch the wall. So the file has two
numbers for these, the same in all rows. A front wheel gives way at 60 kN, 5.5 times its load at rest: chosen
by hand, 30 to 70 kN differ by 1 degree. The wheel then carries nothing until the nose has sunk by 0.82 m
there. In the runs the frame, 0.6 m high, comes down on an axle that was pushed back to 2.1 m ahead of the
mass centre; at the wheel's own place, 2.9 m ahead, that is 0.82 m. This truck has no springs. The front
passes on 0.15 of the friction. In the runs the vertical impulse has a mean size of 3 % of the forward one;
sliding at a friction of 0.2 would give 20 %. Each alone limits the pitch:"""
