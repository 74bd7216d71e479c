"""The part of the truck's page on the preset `cargo_truck`: before and after its fit, and left out."""

from __future__ import annotations

import birm3d
from fit_truck_preset import NUMBERS, PITCH, by_rule, pitch_on_film, read, stress
from truck_runs import runs
from truck_tables import HEAD, SCORE_HEAD, Row, cells, computed, count, score, table

TEXT = """Another truck: its mass, height and length are its own. Three stresses of its front are fitted to
travel and force of these runs and to a pitch on film (`fit_truck_preset.py`). So its travel and force here
are no predictions; pitch and sideways impulses are. Before, its stresses were those of a pickup's front at
the same share of the length, and sheet of an order of magnitude. The preset's file is what is used
everywhere.

The preset's front wheels hold, so that it pitches later than the runs. When it runs on, it comes to 28 and
30 deg at the bollards after 0.75 s. The front wheels of the other truck give way. With such wheels the
preset's pitch at the bollards is 11 and 21 deg when the runs end, and 24 deg at the wall at 50 mph."""

LEFT_OUT = """Each run left out in turn: the same fit to the four others and to the film. It starts from the
file's stresses, which have seen all five runs, and from a first estimate of 0.42 MPa for the ends. The
engine's jam is not fitted: zones bumper_middle and grille_middle keep their width and their rise from 1.3 m
on. These were set by hand, with forces and moments at the bollards in view. Only their stress changes, with
that of rails and engine."""


def sections() -> list[str]:
    """Lines: before, as in the file, each run left out, and the stresses."""
    preset = birm3d.Vehicle.preset("cargo_truck")
    lines = ["## The preset cargo_truck: three of its numbers are fitted to these runs", "", TEXT]
    for title, vehicle in (("Before the fit", by_rule(preset)), ("As in the file", preset)):
        rows = computed(vehicle)
        core = sum(row.own.core_contact for row in rows)
        lines += ["", f"{title}, with {pitch_on_film(vehicle):.0f} deg where film shows {PITCH:.0f}:", ""]
        lines += [*table(HEAD, [cells(row) for row in rows]), ""]
        lines += [f"Met: {count(rows)}. Rigid core met: {core} times."]
    rows = _left_out(preset)
    lines += ["", LEFT_OUT, "", *table(HEAD, [cells(row) for row in rows]), ""]
    lines += [*table(SCORE_HEAD, [score(rows)]), "", *_stresses(preset)]
    return lines


def _left_out(preset: birm3d.Vehicle) -> list[Row]:
    rows = []
    for fit in read():
        if fit.left_out:
            rows += computed(fit.vehicle(preset), [runs()[fit.left_out]])
    return rows


def _stresses(preset: birm3d.Vehicle) -> list[str]:
    every, *others = read()
    before = by_rule(preset)
    lines = []
    for i, name in enumerate(NUMBERS):
        own = 1e-6 * stress(preset, name)
        several = [own * fit.factors[i] for fit in others]
        lines.append(
            [
                name,
                f"{1e-6 * stress(before, name):.3f}",
                f"{own:.3f}",
                f"{own * every.factors[i]:.3f}",
                f"{min(several):.3f} to {max(several):.3f}",
            ]
        )
    head = ("stress up to 0.5 m [MPa]", "before", "in the file", "fitted anew", "with a run left out")
    return table(head, lines)
