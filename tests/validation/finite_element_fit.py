"""Least squares of a skin to finite-element runs: what a vehicle computes of a run, and the fit to several.

What is fitted, and how it is weighted, says fit_finite_element.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import birm3d
import numpy as np
from birm3d.filters import cfc
from finite_element import STANDOFF, Run, scene, touch
from finite_element_skin import Floats, Skin, changed, vehicle_with
from scipy.optimize import least_squares

YAW_MARK = 5.0  # deg
TOLERANCE = 2e-3  # of the steps, and of what they change the sum of squares by
STEP = 0.01  # of differences, as a share of the way between the bounds
YAW_SIGMA = {"n_wall25_30": 5.0}  # deg; half of it for other runs. Independent trusses do not follow this one
SPREAD = 0.7  # of drawn starts, in widths
SEED = 20


@dataclass(frozen=True)
class Prediction:
    """A run as computed: travel [m], CFC60 force [N], yaw [deg], impulse to the left [N s], rebound."""

    crush: float
    peak_force: float
    yaw: float
    lateral_impulse: float
    restitution: float
    closed: float  # greatest deflection as a share of a front truss's length; 1: the core is met


def predicted(vehicle: birm3d.Vehicle, run: Run) -> tuple[Prediction, birm3d.Result]:
    """The run computed with a vehicle."""
    result = scene(vehicle, run).run()
    interval = result.scene.settings.output_interval
    time = result.time - touch(run)
    end = int(np.searchsorted(time, run.end))
    length = np.linalg.norm(vehicle.nodes - vehicle.anchors, axis=1)
    front = [index for index, zone in enumerate(vehicle.zones) if zone.startswith("front")]
    in_front = np.isin(vehicle.zone_of_node, front)
    travel = result.position[:end, 0] - result.position[0, 0] - STANDOFF
    deflection = result.unit(0).peak_deflection[: len(length)]
    found = Prediction(
        crush=float(travel.max()),
        peak_force=float(cfc(-result.barrier_force[:, 0], 60, interval).max()),
        yaw=float(np.interp(run.end, time, result.yaw)),
        lateral_impulse=float(result.barrier_force[1 : end + 1, 1].sum() * interval),
        restitution=float(-np.interp(run.end, time, result.velocity[:, 0]) / result.velocity[0, 0]),
        closed=float((deflection / length)[in_front].max()),
    )
    return found, result


def residuals(vehicle: birm3d.Vehicle, run: Run, yaw_sigma: Mapping[str, float] = YAW_SIGMA) -> Floats:
    """What a fit makes small, shape (n,); yaw_sigma: of the runs that it names, instead of 2.5 deg."""
    found, result = predicted(vehicle, run)
    crush, force = run.vehicle.crush_trust, run.vehicle.force_trust
    scalars = [
        2.0 * (found.crush / run.crush - 1.0) / crush,
        2.0 * (found.peak_force / run.peak_force - 1.0) / force,
    ]
    if run.impact_angle == 90.0 and run.impact_offset == 0.0:
        scalars.append((found.restitution - run.restitution) / 0.04)
    else:
        scalars.append((found.yaw - run.yaw) / yaw_sigma.get(run.name, 0.5 * YAW_MARK))
    if run.impact_offset != 0.0:
        scalars.append((found.lateral_impulse - run.lateral_impulse) / run.normal_impulse / 0.04)
    return np.concatenate([scalars, _curve(result, run) / force])


def _curve(result: birm3d.Result, run: Run) -> Floats:
    """Of the CFC60 force at points 4 ms apart, as a share of its peak; together they count as one."""
    interval = result.scene.settings.output_interval
    computed = cfc(-result.barrier_force[:, 0], 60, interval)
    at = np.arange(0.0, run.time[-1], 4e-3)
    ours = np.interp(at, result.time - 0.5 * interval - touch(run), computed)
    return (ours - np.interp(at, run.time, run.force)) / run.peak_force / np.sqrt(len(at))


@dataclass(frozen=True)
class Fit:
    """Shares of the unknowns, shape (n,); their standard deviations, in widths; half the sum of squares."""

    shares: Floats
    deviation: Floats
    cost: float


def fit(
    skin: Skin,
    known: Sequence[Run],
    steps: int,
    starts: int,
    yaw_sigma: Mapping[str, float] = YAW_SIGMA,
) -> Fit:
    """The best of fits that start from what is expected, and from values drawn about it."""
    random = np.random.default_rng(SEED)
    away = [np.zeros(len(skin.unknowns))]
    away += [random.normal(0.0, SPREAD, len(skin.unknowns)) for _ in range(starts - 1)]
    base = vehicle_with(skin, skin.values(skin.start(away[0])), "start").with_mesh_density(skin.fit_density)

    def all_residuals(shares: Floats) -> Floats:
        vehicle = changed(base, skin, skin.values(shares))
        return np.concatenate(
            [*(residuals(vehicle, run, yaw_sigma) for run in known), skin.departures(shares)]
        )

    def jacobian(shares: Floats) -> Floats:
        return _jacobian(all_residuals, shares)

    def fit_from(start: Floats) -> Any:
        inside = np.clip(skin.start(start), STEP, 1.0 - STEP)
        limits = {"ftol": TOLERANCE, "xtol": TOLERANCE, "max_nfev": steps}
        return least_squares(all_residuals, inside, jacobian, bounds=(0.0, 1.0), **limits)

    best = min((fit_from(start) for start in away), key=lambda found: float(found.cost))
    covariance = np.linalg.inv(best.jac.T @ best.jac)
    # The departures are the last rows, each of one share.
    scale = np.abs(np.diag(best.jac[-len(skin.unknowns) :]))
    return Fit(best.x, np.sqrt(np.diag(covariance)) * scale, float(best.cost))


def _jacobian(function: Callable[[Floats], Floats], at: Floats) -> Floats:
    here = function(at)
    columns = []
    for i in range(len(at)):
        step = STEP if at[i] + STEP <= 1.0 else -STEP
        moved = at.copy()
        moved[i] += step
        columns.append((function(moved) - here) / step)
    return np.array(columns).T
