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
from birm3d.reporting.given_tests import GivenTest, given_tests

PAGE = Path(__file__).with_name("ratings.md")

_HEAD = """# Ratings and occupant risk beside published tests

Written by `python tests/validation/rating_page.py`. Vehicles are the presets, brought to the mass of the
test; no number was fitted to these tests, but for the sedan's front (NHTSA 10146). Barriers are rigid and
fixed. A rating that is computed is indicative. Where the model can not know what decided a test, the row
says so.

The scenes of MASH 4-11, of the two tractor-trailers and of the broadside pickup are those of the
[page of all tests](README.md). Greatest roll is that of both units here, and that of the tractor there. MASH
4-12 is 2214NJ-2 there. TB11 and TB51 have nominal speeds and angles on both pages. Here the profile is a New
Jersey of 0.9 m, there one of 0.81 m.
"""


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


def _row(case: GivenTest) -> list[str]:
    rating = rated(case)
    right = "right" if rating.contained == case.measured else "**wrong**"
    row = {one.name: one for one in rating.criteria}
    own = rating.designation
    own += "".join(f"; {name} {row[name].shown}" for name in ("ASI", "greatest roll") if name in row)
    contained = "contained" if rating.contained else "not contained"
    return [case.name, own, contained, f"{rating.penetration:.2f}", case.published, right, case.note]


def _table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines) + "\n"


def page() -> str:
    """Return the page."""
    rows = [_row(case) for case in CASES]
    right = sum(row[5] == "right" for row in rows)
    computed = sum(row[2] == "contained" for row in rows)
    published = sum(bool(case.measured) for case in CASES)
    ratings = _table(
        ["test", "computed rating", "computed", "penetration [m]", "published", "containment", "note"], rows
    )
    risk = _table(["test", "value", "computed", "published", "error"], _risk_rows())
    sources = "\n".join(f"- {case.name}: {case.source}" for case in CASES)
    return f"""{_HEAD}
## Ratings

Containment is as published in {right} of {len(rows)} tests. {computed} are computed as contained,
and {published} were. Penetration is that of the standard's point past its datum; of
roadside tests that of any part of the vehicle past the traffic face.

{ratings}
## Occupant risk

The sedan's channels are those of the compartment; the model's vehicle is one body, so that its pulse is that
of the momentum centre. The pole of the second test stands where the mass centre goes: there the preset's
side gives way until the pole is at the rigid body, which it should not.

{risk}
## Left out

JERSEY-4000 (a section broke; angle not stated), TT203, TT210, DSC7000 (not bollards; sizes not published),
TTI's 1975 sedan at 24 deg, T60-KIA and FOIL 03008 (neither rating nor outcome published).

## Dossiers

`python tests/validation/rating_page.py --dossiers FOLDER` writes those of all these tests, and of
{"; ".join(case.name for case in DOSSIERS if not case.standard)}.
Their verdicts are those of this page.

## Sources

{sources}
- NHTSA 10146: NHTSA vehicle crash test database, compartment channels reduced at 10 kHz
- FOIL C2500: FHWA FOIL broadside rigid-pole test, results table (ntlrepository, lib/5000/5400/5481)
"""


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
