"""Finite-element runs of a truck: walls, bollards."""

from __future__ import annotations

from collections.abc import Sequence

import birm3d
import numpy as np
from comparison import Row, about
from truck_runs import FITTED, Run, figures, runs, scene
from truck_tables import MARKS, MOMENT, ROLL

NAME = "finite_element_truck"
TITLE = "Finite-element truck: walls and bollards"
TEXT = """Vehicles: `tests/data/finite_element/fitted_truck.toml`, thirteen numbers of which are fitted to all
five runs; and the preset `cargo_truck`, another truck (its mass, height and length are its own). Three
stresses of its front are fitted to travel and force of the runs (`fit_truck_preset.py`, which leaves
each run out in turn, too). A run's name says the barrier and the speed in mph: `wall25_50` is a wall at 25
degrees from head-on, `bollards3_50` a row of three bollards.
Marks: travel 12 %, force over 50 ms 15 %, overturning moment 15 %, impulse sideways on each post 20 kN s,
pitch and roll 5 degrees. They are targets: repeats of a run differ by 5 % in travel and in force over 50 ms.
Pitch and roll are the greatest until the run ends, 0.12 to 0.25 s after the touch. The moment is the greatest
50-ms mean about the foot of the wall, or of the post that has most. The truck's fit looks at moments, that of
the preset does not; neither looks at rolls. Where the preset's engine jams was set by hand, with
forces and moments at the bollards in view: these moments are called fitted. Those at walls are called
predicted. But a moment is force times height, and the preset's forces are fitted.

What the model can not do here: the engine stops in a post while the frame goes on. The bed, which here is
fixed, slides at the wall at 50 mph and brings a third of the momentum later. A bumper's end is bent away by
a post that overlaps it by 85 mm. A frame that bends jams between two posts. The model's rigid body has none
of these; [its page](truck.md) has the sizes, and the same truck with a bed that slides. The fitted truck
pitches as far as the runs because its front wheels give way and its front passes on less friction. The
preset's front wheels hold, and it pitches later."""


def tasks() -> Sequence[str]:
    """Each run with each vehicle."""
    return [f"{name} {vehicle}" for vehicle in ("fitted_truck", "cargo_truck") for name in runs()]


def rows(task: str) -> list[Row]:
    """What one task is compared in."""
    name, who = task.split()
    run = runs()[name]
    fitted = who == "fitted_truck"
    vehicle = birm3d.Vehicle.from_file(FITTED) if fitted else birm3d.Vehicle.preset(who)
    own = figures(scene(vehicle, run).run())
    role = "fitted" if fitted else "predicted"  # the preset's pitch and sideways impulses
    travel, force = about(run.travel, MARKS["travel"]), about(run.force_50ms, MARKS["force"])
    pitch = (run.pitch - MARKS["pitch"], run.pitch + MARKS["pitch"])
    return [
        Row(name, who, "travel", "m", run.travel, *travel, own.travel, "fitted"),
        Row(name, who, "force over 50 ms", "N", run.force_50ms, *force, own.force_50ms, "fitted"),
        *_moment(run, who, own.moment, "fitted" if run.posts else role),
        Row(name, who, "pitch", "deg", run.pitch, *pitch, own.pitch, role),
        *_roll(run, who, own.roll, role),
        *_sideways(run, who, own.impulse, role),
    ]


def _moment(run: Run, who: str, own: float, role: str) -> list[Row]:
    if run.moment is None:
        return []
    mark = about(run.moment, MOMENT)
    return [Row(run.name, who, "overturning moment", "N m", run.moment, *mark, own, role)]


def _roll(run: Run, who: str, own: float, role: str) -> list[Row]:
    """Of runs that are not the same on both sides: the others have none."""
    if run.impact_angle == 90.0 and sum(run.posts) == 0.0:
        return []
    return [Row(run.name, who, "greatest roll", "deg", run.roll, run.roll - ROLL, run.roll + ROLL, own, role)]


def _sideways(run: Run, who: str, impulse: np.ndarray, role: str) -> list[Row]:
    """Of the post that is met worst: what it takes to the left, less what the run has there."""
    if not run.posts:
        return []
    difference = (impulse - run.impulse)[:, 1]
    worst = float(difference[np.argmax(np.abs(difference))])
    mark = MARKS["sideways"]
    return [
        Row(run.name, who, "sideways impulse, worst post, difference", "N s", 0.0, -mark, mark, worst, role)
    ]
