"""Differences between a computed truck and a finite-element run, each over its standard deviation."""

from __future__ import annotations

import birm3d
import numpy as np
import numpy.typing as npt
from birm3d.filters import cfc
from truck_runs import STANDOFF, Run, figures, scene, whole_position, with_loaded_posts

Floats = npt.NDArray[np.float64]

# One body with few numbers can not come as close as repeats of a run do, 4 and 5 %. So travel and force have
# half of their marks (shares), pitch its mark (deg). The overturning moment has twice its mark (share): the
# height of its force is that of parts which one body does not have. Loads on a post in N s: sideways they
# come from a frame that bends between two posts.
TRAVEL, FORCE, MOMENT, PITCH, SIDEWAYS, FORWARD = 0.06, 0.075, 0.3, 5.0, 20e3, 15e3
# Curves count as so many points. The force has spikes of an engine that one rigid body can not follow (share
# of the peak). The displacement (share of the travel) tells when a force acts.
FORCE_CURVE, FORCE_POINTS = 0.2, 8.0
DISPLACEMENT_CURVE, DISPLACEMENT_POINTS = 0.05, 4.0
# Where an indentation just reaches a stiff part of the front, loads on a post jump. The place of the jump is
# not to be believed: residuals at posts are means over these factors on the reach.
REACHES = (0.95, 1.05)


def residuals(vehicle: birm3d.Vehicle, run: Run) -> Floats:
    """Computed less the run's, each over its standard deviation, shape (n,)."""
    result = scene(vehicle, run).run()
    own = figures(result)
    scalars = [
        (own.travel / run.travel - 1.0) / TRAVEL,
        (own.force_50ms / run.force_50ms - 1.0) / FORCE,
        (own.pitch - run.pitch) / PITCH,
    ]
    if run.moment is not None:
        scalars.append((own.moment / run.moment - 1.0) / MOMENT)
    posts = (own.impulse - run.impulse) / [FORWARD, SIDEWAYS] if run.posts else np.empty((0, 2))
    time = result.time - STANDOFF / result.velocity[0, 0]
    filtered = cfc(result.barrier_normal_force, 60, result.scene.settings.output_interval)
    force = np.interp(run.time, time, filtered, right=0.0)
    curve = (force - run.force) / (FORCE_CURVE * run.peak_force) * np.sqrt(FORCE_POINTS / len(run.time))
    place = whole_position(result)
    way = np.interp(run.time, time, place - place[0] - result.scene.standoff)
    ways = (way - run.displacement) / (DISPLACEMENT_CURVE * run.travel)
    ways *= np.sqrt(DISPLACEMENT_POINTS / len(run.time))
    return np.concatenate([scalars, posts.ravel(), curve, ways])


def smoothed(vehicle: birm3d.Vehicle, run: Run) -> Floats:
    """Residuals, at posts as means over REACHES, with all posts and with those alone that took a load."""
    if not run.posts:
        return residuals(vehicle, run)
    reach = vehicle.units[0].indentation_length
    several = [
        residuals(vehicle.with_indentation_length(reach * factor), same)
        for same in dict.fromkeys((run, with_loaded_posts(run)))
        for factor in REACHES
    ]
    return np.asarray(np.concatenate(several) / np.sqrt(len(several)))
