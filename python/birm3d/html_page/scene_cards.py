"""What notebooks show of vehicles, barriers and simulations: a compact table each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from .. import units
from ..base.plain_words import plain_words
from ..scene.text import overlap_text, scene_text
from ..vehicle.title import kind_words, vehicle_text
from .notebook import card, table_html

if TYPE_CHECKING:
    from ..barrier.barrier import Barrier
    from ..scene.scene import Scene
    from ..vehicle.vehicle import Vehicle

__all__ = ["barrier_html", "scene_html", "turned_rows", "vehicle_html"]

_Row = tuple[str, str]


def vehicle_html(vehicle: Vehicle) -> str:
    """Return name, kind, mass, sizes and mesh of a vehicle."""
    return card(vehicle_text(vehicle), table_html(("", ""), _vehicle_rows(vehicle)))


def barrier_html(barrier: Barrier) -> str:
    """Return kind, sizes and place of a barrier."""
    return card(barrier.text, table_html(("", ""), _barrier_rows(barrier)))


def scene_html(scene: Scene) -> str:
    """Return how the vehicle comes to the barrier, and both of them."""
    rows = list(_approach_rows(scene))
    tables = [("impact", rows), ("vehicle", list(_vehicle_rows(scene.vehicle)))]
    if scene.barrier is not None:
        tables.append(("barrier", list(_barrier_rows(scene.barrier))))
    return card(scene_text(scene), "".join(table_html((name, ""), each) for name, each in tables))


def _vehicle_rows(vehicle: Vehicle) -> Iterator[_Row]:
    yield "name", vehicle.name
    if vehicle.kind is not None:
        yield "kind", kind_words(vehicle.kind)
    yield "mass", f"{vehicle.mass:,.0f} kg"
    yield "length x width x height", f"{vehicle.length:.2f} x {vehicle.width:.2f} x {vehicle.height:.2f} m"
    if vehicle.wheelbase is not None:
        yield "wheelbase", f"{vehicle.wheelbase:.2f} m"
    if len(vehicle.units) == 1:
        yield "height of the mass centre", f"{vehicle.mass_center_height:.2f} m"
    else:
        yield "units", ", ".join(f"{unit.name} ({unit.mass:,.0f} kg)" for unit in vehicle.units)
    yield "nodes of the skin", f"{vehicle.n_nodes:,}"


def _barrier_rows(barrier: Barrier) -> Iterator[_Row]:
    yield "kind", barrier.title
    for size in barrier.sizes:
        value = getattr(barrier, size.name, None)
        if size.quantity == "flag":
            yield plain_words(size.name), "yes" if value else "no"
        elif value is not None:
            hint = f" ({size.hint})" if size.hint else ""
            yield f"{plain_words(size.name)}{hint}", _size_text(value, size.unit)
    yield "friction", f"{barrier.friction:g}"
    yield "origin", f"{', '.join(f'{place:g}' for place in barrier.origin)} m"
    yield "heading", f"{barrier.heading:g}°"


def _size_text(value: object, unit: str) -> str:
    if not isinstance(value, (int, float)):
        return str(value)
    return "without end" if math.isinf(value) else f"{value:g} {unit}".rstrip()


def turned_rows(scene: Scene) -> Iterator[_Row]:
    """Yield yaw and roll at impact, those that are not 0."""
    for name in ("impact_yaw", "impact_roll"):
        if getattr(scene, name) != 0.0:
            yield name.removeprefix("impact_"), f"{getattr(scene, name):g}°"


def _approach_rows(scene: Scene) -> Iterator[_Row]:
    speed = scene.impact_speed
    yield "speed", f"{speed:.2f} m/s ({speed / units.km_h:.1f} km/h, {speed / units.mph:.1f} mph)"
    if scene.barrier is not None:
        yield "angle", f"{scene.impact_angle:g}°"
        yield "offset", f"{scene.path_offset:.3g} m{overlap_text(scene)}"
        yield "standoff", f"{scene.standoff:g} m"
    yield from turned_rows(scene)
    yield "duration", "until the outcome is decided" if scene.duration is None else f"{scene.duration:g} s"
