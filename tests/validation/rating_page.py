"""Published tests run through birm3d.rate() and occupant_risk(), their verdicts side by side, right or wrong.

    python tests/validation/rating_page.py

writes tests/validation/ratings.md, and

    python tests/validation/rating_page.py --dossiers FOLDER

a dossier for each of the published tests below the folder, its published verdict or value in the head.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

import birm3d
from birm3d import Rating, units
from birm3d.assessment.limits import severity_class
from birm3d.reporting.given_tests import GivenTest, given_tests
from birm3d.reporting.published_class import class_of, judged_class

PAGE = Path(__file__).with_name("ratings.md")
COMPUTED = Path(__file__).with_name("results") / "redirection_computed.txt"  # written by all_tests.py

_HEAD = """# Ratings and occupant risk beside published tests

Written by `python tests/validation/rating_page.py`. Vehicles are the presets, brought to the mass of the
test; no number was fitted to these tests, but for the sedan's front (NHTSA 10146). Barriers are rigid and
fixed. A rating that is computed is indicative. Where the model can not know what decided a test, the row
says so.

The scenes of MASH 4-11, of the two tractor-trailers and of the broadside pickup are those of the
[page of all tests](README.md). Greatest roll is that of both units here, and that of the tractor there. MASH
4-12 is 2214NJ-2 there. The computed truck is at its tipping point: small changes of the scene decide whether
it overturns. One row there has containment and standing upright together.
TB11 and TB51 are SWOV TB11 and SWOV TB51 there, with the preset of the class, loaded to the mass of the test.
Here TB11 is a sedan's shape at 900 kg, and the bus of TB51 is scaled. The notes have what is computed there.
"""


_HOW = """Penetration is that of the standard's point past its datum; of roadside tests that of any part of
the vehicle past the traffic face. Class or penetration: right if the class of the computed penetration is
that of the published one. ASTM F2656 classes the dynamic penetration: P1 up to 1 m, P2 up to 7 m. Of
roadside tests the verdict is judged, and the severity by ASI where it was published. Containment counts
here, too, where it is as commonly reported: see the sources."""


REPEATED = {"TB11": "SWOV TB11", "TB51": "SWOV TB51"}
"""First words of tests here, and their names on the page of all tests, where another vehicle stands in."""


_RISK = """The sedan's channels are those of the compartment; the model's vehicle is one body, so that its
pulse is that of the momentum centre. The pole of the second test stands where the mass centre goes: there
the preset's side gives way until the pole is at the rigid body, which it should not."""


LEFT_OUT = (
    ("Delta DSC720FP, fixed bollard", "sizes are published, but no result of a test"),
    (
        "Delta DSC7000, beam barricade",
        "a beam, no bollard: neither its sizes nor those of its supports are published",
    ),
    ("Delta TT203, penetrated by 3.7 m at 51 km/h", "no size of what was hit is published"),
    ("Delta TT210, no penetration at 64 km/h", "no size of what was hit is published"),
    (
        "anchored concrete median, 1.8-t car at 80 km/h (MIL-HDBK-1013/14), penetrated by 6.0 m",
        "the angle is not published; a section broke and overturned, and barriers of the model do not break",
    ),
    (
        "PPG fixed M50 bollards, M50-P1, V/7500[N3]/80/90:0.4, V/7200[N3C]/80/90:0.8",
        "diameter and height of the bollards are not published",
    ),
    (
        "TTI, 1975 sedan at 24 deg into a wall",
        "neither a rating nor the outcome is published where it was read",
    ),
    (
        "TTI, heavy vehicles at instrumented walls (Beason and Hirsch 1989)",
        "only the list of vehicles was read",
    ),
    ("TTI, 36-t tractor-trailers at a pier (2011)", "force histories exist and were not read"),
    ("TTI 420020-9b, 10-t truck at a single slope", "conditions and outcome as commonly reported only"),
    (
        "Caltrans Type 60, Kia Rio (140MASH3C16-04)",
        "conditions are published, rating and outcome were not read",
    ),
    (
        "FHWA FOIL 03008, tractor without a trailer",
        "conditions are published, rating and outcome were not read",
    ),
    (
        "MwRSF, Honda Civic at a New Jersey rail with a step of 4.5 in",
        "the summary says that such a car is likely to roll, not what this one did",
    ),
    ("MwRSF, Manitoba tall wall, MASH 5-12", "speed and angle were not read"),
    (
        "SWOV R-96-26, TB11 and TB51 on an anchored steel STEP barrier",
        "a steel barrier, how far it moved was not read; exit 9 and 2 deg, roll of the bus about 25 deg",
    ),
)
"""Published tests that have no row, each with its reason."""


CASES = tuple(test for test in given_tests() if test.quantity == "containment")
"""Published tests that come with the package, data/published_tests.csv."""


_OTHERS = [test for test in given_tests() if test.quantity != "containment" and test.recipe[1] != "nhtsa"]
DOSSIERS = (*CASES, *{test.recipe: test for test in reversed(_OTHERS)}.values())
"""Tests that get a dossier, one a scene: those that were rated, and those with a scene of their own."""


def write_dossier(case: GivenTest, folder: Path, *, draws: int = 16) -> Path:
    """Write the dossier of a test below a folder, what was published in the head; return the page.

    Parameters
    ----------
    draws
        Of vehicles of the class, see :func:`birm3d.dossier`.
    """
    name = re.sub(r"[^a-z0-9]+", "-", case.name.lower()).strip("-")
    values = [
        f"{one.quantity.replace('_', ' ')} {one.measured:g} {one.unit}".strip()
        for one in _OTHERS
        if one.recipe == case.recipe
    ]
    return birm3d.dossier(
        case.simulation().run(),
        folder / name,
        standards=[case.standard] if case.standard else None,
        vehicle_class=case.vehicle_class or None,
        draws=draws,
        title=f"{case.name}: published {case.published or ', '.join(values)}",
        project=f"Published test; {case.source}",
    )


def _risk_rows() -> list[list[str]]:
    """Occupant risk of two tests beside what was published or reduced from their channels."""
    sedan = birm3d.occupant_risk(birm3d.scenes.nhtsa_10146().run())
    (broadside_test,) = (test for test in _OTHERS if "broadside" in test.name)
    side = broadside_test.simulation().run()
    broadside = birm3d.occupant_risk(side)
    force = side.metrics["peak_normal_force_cfc60"] / units.kN
    compartment = "NHTSA 10146, 57 km/h into a wall"
    foil = "FHWA FOIL, C2500 broadside into a pole, 52.8 km/h"
    rows = [
        (compartment, "OIV, longitudinal", sedan.oiv_x, 17.96, "m/s"),
        (compartment, "ridedown, longitudinal", sedan.ridedown_x, 4.5, "g"),
        (compartment, "50-ms mean / 12 g (ASI, 1998)", sedan.asi_1998, 28.5 / 12.0, ""),
        (compartment, "OLC", sedan.olc, 29.7, "g"),
        (foil, "OIV, lateral", broadside.oiv_y, 10.2, "m/s"),
        (foil, "ridedown, lateral", broadside.ridedown_y, 9.7, "g"),
        (foil, "peak load on the pole", force, 301.28, "kN"),
    ]
    return [
        [test, what, f"{own:.2f} {unit}".strip(), f"{given:.2f} {unit}".strip(), f"{own / given - 1.0:+.0%}"]
        for test, what, own, given, unit in rows
    ]


def rated(case: GivenTest) -> Rating:
    """Return the rating of a case."""
    return birm3d.rate(case.simulation().run(), case.standard, vehicle_class=case.vehicle_class or None)


def _row(case: GivenTest, rating: Rating) -> list[str]:
    right = "right" if rating.contained == case.measured else "**wrong**"
    judged = judged_class(case.published_class, rating).replace("wrong", "**wrong**")
    row = {one.name: one for one in rating.criteria}
    own = rating.designation
    own += "".join(f"; {name} {row[name].shown}" for name in ("ASI", "greatest roll") if name in row)
    contained = "contained" if rating.contained else "not contained"
    penetration = f"{rating.penetration:.2f}"
    return [case.name, own, contained, penetration, case.published, right, judged, note_of(case)]


def note_of(case: GivenTest) -> str:
    """Return the last cell of a case: its own note, then what the page of all tests has of it."""
    return "; ".join(filter(None, (case.note, _elsewhere(case))))


def _elsewhere(case: GivenTest) -> str:
    """Return what the page of all tests has of a case, with the vehicle that stands for it there."""
    name = REPEATED.get(case.name.split(",")[0])
    if name is None:
        return ""
    rows = COMPUTED.read_text(encoding="utf-8").splitlines()
    (cells,) = (row.split("; ") for row in rows if row.startswith(f"{name}; "))
    vehicle, mass = cells[1].split(" ", 1)
    told = f"on the page of all tests, `{vehicle}` loaded to {mass}: roll {cells[5]} deg"
    published = re.search("severity ([ABC])", case.published_class)
    if published is None:
        return told
    asi = float(cells[-1])
    judged = "right" if published[1] == severity_class(asi) else "**wrong**"
    return f"{told}; ASI {asi:.2f}, class {severity_class(asi)}: {judged}"


def _table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines) + "\n"


def page() -> str:
    """Return the page."""
    found = [rated(case) for case in CASES]
    rows = [_row(case, rating) for case, rating in zip(CASES, found, strict=True)]
    ratings = _table(
        [
            *("test", "computed rating", "computed", "penetration [m]", "published"),
            *("containment", "class or penetration", "note"),
        ],
        rows,
    )
    risk = _table(["test", "value", "computed", "published", "error"], _risk_rows())
    left_out = _table(["test", "why it is left out"], [list(one) for one in LEFT_OUT])
    sources = "\n".join(f"- {case.name}: {case.source}" for case in CASES)
    others = "; ".join(case.name for case in DOSSIERS if not case.standard)
    return f"""{_HEAD}
## Ratings

{_counts(rows, found)}

{_HOW}

{ratings}
## Occupant risk

{_RISK}

{risk}
## Left out

Published tests that were looked at and are not in the table.

{left_out}
## Dossiers

`python tests/validation/rating_page.py --dossiers FOLDER` writes those of all these tests, and of
{others}.
Their verdicts are those of this page.

## Sources

{sources}
- NHTSA 10146: NHTSA vehicle crash test database, compartment channels reduced at 10 kHz
- FOIL C2500: FHWA FOIL broadside rigid-pole test, results table (ntlrepository, lib/5000/5400/5481)
"""


def _counts(rows: list[list[str]], found: list[Rating]) -> str:
    """Return how many verdicts are as published; README.md and docs/pages/validation.md repeat it."""
    right = sum(row[5] == "right" for row in rows)
    computed = sum(row[2] == "contained" for row in rows)
    published = sum(bool(case.measured) for case in CASES)
    judged = [row[6] for row in rows if row[6] != "not published"]
    posts = [
        (class_of(rating), case.published_class)
        for case, rating in zip(CASES, found, strict=True)
        if case.recipe[3] == "bollards" and case.penetration is not None
    ]
    best, were = sum(own == "P1" for own, _ in posts), sum(given == "P1" for _, given in posts)
    n, met = len(judged), judged.count("right")
    return f"""Containment is as published in {right} of {len(rows)} tests. {computed} are computed as
contained, and {published} were. A class or a penetration was published of {n} tests, and is as published in
{met}. Of {len(posts)} tests at posts with a published penetration, {best} are computed in the best class, P1,
and {were} were in it."""


def main() -> None:
    """Write the page, or dossiers."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--dossiers", type=Path, metavar="FOLDER", help="write dossiers there, not the page")
    folder = parser.parse_args().dossiers
    if folder is None:
        PAGE.write_text(page(), encoding="utf-8")
        print(f"written: {PAGE}")
        return
    folder.mkdir(parents=True, exist_ok=True)
    for case in DOSSIERS:
        print(f"written: {write_dossier(case, folder)}", flush=True)


if __name__ == "__main__":
    main()
