"""Crashes of vehicles at one rigid post: what posts.py and post_ratios.py compute."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "bench"))

import birm3d
import numpy as np
from finite_element import DATA

_SPEED = {
    **dict.fromkeys(("fitted_n", "fitted_s"), birm3d.units.mph(30)),
    "fitted_truck": birm3d.units.mph(50),
}
_OF_PRESETS = birm3d.units.km_h(56)


def speed(name: str) -> float:
    """Speed that the vehicle is driven at [m/s]."""
    return _SPEED.get(name, _OF_PRESETS)


@cache
def vehicle(name: str) -> birm3d.Vehicle:
    """A preset, or a vehicle that is fitted to finite-element runs."""
    if name.startswith("fitted"):
        return birm3d.Vehicle.from_file(DATA / f"{name}.toml")
    return birm3d.Vehicle.preset(name)


def half_width(who: birm3d.Vehicle) -> float:
    """Greatest distance of a node of the first unit from the plane of symmetry [m]."""
    return float(who.units[0].nodes[:, 1].max())


def crash(
    who: birm3d.Vehicle,
    speed: float,
    offset: float,
    *,
    diameter: float,
    height: float = 1.5,
    friction: float = 0.0,
    tolerance: float = 1e-3,
) -> birm3d.Result:
    """Run a vehicle head-on at one post, whose axis is `offset` to the right of the middle [m]."""
    post = birm3d.Barrier.bollards(
        count=1, diameter=diameter, height=height, origin=(0.0, -offset, 0.0), friction=friction
    )
    settings = birm3d.Settings(mu_tire=0.0, mu_body=0.0, mu_tire_barrier=0.0, tolerance=tolerance)
    return birm3d.Simulation(who, post, speed, duration=0.25, settings=settings).run()


def impulse(result: birm3d.Result, until: float = np.inf) -> np.ndarray:
    """Impulse on the post up to a time [s], forward and to the vehicle's left [N s]."""
    (on_post,) = result.element_loads
    rows = (result.time > 0.0) & (result.time <= until)
    return np.asarray(on_post.force[rows, :2].sum(0) * result.scene.settings.output_interval)
