"""Scene and vehicle: what was run, and where its numbers come from."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .. import units
from ..barrier.barrier import Barrier
from ..barrier.text import barrier_text
from ..base.plain_words import plain_words
from ..base.shown_numbers import shown_value
from ..result.report import END_REASONS
from ..scene.text import overlap_text
from ..simulation.zone_numbers import unit_of_number
from ..vehicle import Vehicle
from ..vehicle.title import kind_words, vehicle_text
from ..vehicle.zone import LAW_NUMBERS
from .blocks import Block, Caution, Section, Table, Text
from .figures import figure
from .study_case import Case

__all__ = ["scene_section", "vehicle_section"]

_ARRAYS = (
    "This vehicle was given as arrays: mass, inertia and stiffness of each truss by value. Nothing is known "
    "of the sources of its numbers."
)

_NO_SOURCE = "no source given"

_QUANTITIES = {
    "mass_kg": "mass [kg]",
    "cg_behind_front_axle_m": "mass centre behind the front axle [m]",
    "cg_height_m": "mass centre above the ground [m]",
    "Ixx_kg_m2": "roll inertia [kg m²]",
    "Iyy_kg_m2": "pitch inertia [kg m²]",
    "Izz_kg_m2": "yaw inertia [kg m²]",
}


def scene_section(case: Case) -> Section:
    """Return what was run: a table and a plan."""
    result = case.result
    scene = result.scene
    rows = [
        ("vehicle", vehicle_text(scene.vehicle, 1)),
        ("barrier", barrier_text(scene.barrier)),
        *_barrier_rows(case),
        (
            "impact speed",
            f"{scene.impact_speed:.3f} m/s ({scene.impact_speed / units.km_h:.1f} km/h, "
            f"{scene.impact_speed / units.mph:.1f} mph)",
        ),
        ("impact angle", f"{scene.impact_angle:g}° between the path and the barrier's line (90°: head-on)"),
        ("impact offset", f"{scene.path_offset:.4g} m along the barrier's line{overlap_text(scene)}"),
        ("yaw, roll at impact", f"{scene.impact_yaw:g}°, {scene.impact_roll:g}°"),
        ("kinetic energy at impact", f"{result.energy['kinetic'][0] / 1e3:,.1f} kJ"),
        ("ended", f"at {result.time[-1]:.4f} s: {END_REASONS[result.end_reason]}"),
    ]
    blocks: list[Block] = [
        figure(
            result.plot_plan(),
            "Plan view of the trajectory; outlines from above, with what overhangs the barrier"
            f"{_ends(scene.barrier)}",
        ),
        Table("Scene", ("", "value"), rows),
    ]
    return Section("Scene", "scene", blocks)


def _ends(barrier: Barrier | None) -> str:
    """Return why the ends of free-standing segments overlap in a plan view, as the end of a caption."""
    free = getattr(barrier, "free_standing", None)
    if barrier is None or free is None or len(barrier.core.segments) < 2:
        return ""
    if free.joint != "pinned":
        return ". Loose segments do not touch each other in this model: their outlines may overlap"
    return (
        ". Segments turn about pins at the middle of their ends. Where the chain kinks, square ends overlap "
        "on the inner side: their contact is not computed, and real ones may lock there"
    )


def _barrier_rows(case: Case) -> Iterator[tuple[str, str]]:
    barrier = case.result.scene.barrier
    if barrier is None:
        return
    stands = "fixed: it does not move"
    if barrier.core.segments:
        stands = "free-standing segments"
    elif barrier.core.yielding_posts:
        stands = "posts that yield at the ground, or turn with their foundation"
    yield "barrier stands", stands
    yield "friction of vehicle on barrier", f"{barrier.friction:g}"
    if any(barrier.origin) or barrier.heading:
        origin = ", ".join(f"{x:g}" for x in barrier.origin)
        yield "origin, heading", f"({origin}) m, {barrier.heading:g}°"


def vehicle_section(case: Case) -> Section:
    """Return each unit's facts, bands, stiffness and sources."""
    vehicle = case.result.scene.vehicle
    blocks: list[Block] = []
    for unit in vehicle.units:
        blocks += _unit_blocks(unit)
    if vehicle.joint is not None:
        blocks.append(Text(f"The units are joined by a {vehicle.joint.kind}."))
    return Section("Vehicle and its sources", "vehicle", blocks)


def _unit_blocks(unit: Vehicle) -> Iterator[Block]:
    file: Any = unit._file
    if file is not None:
        yield Text(f"{file.title}. {file.description}")
    yield Table(f"{unit.title}: facts", ("", "value", "source"), list(_facts(unit)))
    if file is None:
        yield Caution(_ARRAYS)
        return
    if file.targets:
        rows = [
            (
                _QUANTITIES[target.quantity],
                f"{_plain(target.value)} ± {_plain(target.tolerance)}",
                f"{target.at_gvw_kg:,.0f} kg",
                target.status,
                ", ".join(target.source) or _NO_SOURCE,
            )
            for target in file.targets
        ]
        head = ("mass property", "value and band", "at a mass of", "status", "source")
        note = "The file's solids meet these bands."
        yield Table(f"{unit.title}: mass properties and their bands", head, rows, note=note)
    laws = {zone.name: zone for zone in file.zones}
    for zone in file.zones:
        laws.update(zone.second_laws)
    yield Table(
        f"{unit.title}: stiffness zones",
        ("zone", "law per unit of area", "status", "source"),
        [
            (_zone_words(name), _law(law), *_remarks(laws.get(name), law != file.laws.get(name)))
            for name, law in unit.zones.items()
        ],
    )
    sources = [(source.id, source.text, source.status) for source in file.sources]
    yield Table(f"{unit.title}: sources", ("id", "source", "status"), sources)


def _plain(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:.4g}"


def _remarks(zone: Any, changed: bool) -> tuple[str, str]:
    """Return status and sources of a zone; of one that is not the file's that it was changed."""
    if zone is None:
        return _NO_SOURCE, _NO_SOURCE
    source = ", ".join(zone.source) or _NO_SOURCE
    if changed:
        return "changed", f"scaled or set by the user; file: {source}"
    return zone.status, source


def _zone_words(name: str) -> str:
    """Return a zone in words; ``door.along`` is what the door resists along the vehicle."""
    zone, _, second = plain_words(name).partition(".")
    return f"{zone}, {second} the vehicle" if second else zone


def _law(law: Any) -> str:
    parts = []
    for name, value in law.items():
        if name == "envelope":
            points = ", ".join(f"{d:.4g} m: {shown_value(stress, 'N per m^2', 3)}" for d, stress in value)
            parts.append(f"points {points}")
        elif value is not None:
            number = shown_value(value, unit_of_number(name, of_zone=True))
            parts.append(f"{LAW_NUMBERS[name].words} {number}")
    return "; ".join(parts)


def _facts(unit: Vehicle) -> Iterator[tuple[str, str, str]]:
    """Yield each fact with the identifiers of its sources."""
    file: Any = unit._file
    size = wheels = solids = _NO_SOURCE
    if file is not None:
        size = ", ".join(file.dimensions.source)
        wheels, solids = _sources_of(file.wheels), _sources_of(file.solids)
    given = file is not None and unit.mass == file.gvw_kg
    yield "mass", f"{unit.mass:,.1f} kg", "stated in the vehicle's file" if given else "set by the user"
    if unit.kind is not None:
        yield "kind", kind_words(unit.kind), "stated in the vehicle's file"
    for name in ("length", "width", "height", "wheelbase", "track"):
        length = getattr(unit, name)
        if length is not None:
            yield name, f"{length:.3f} m", wheels if name == "track" else size
    source = solids if unit._height is None else "set by the user"
    yield "mass centre above the ground", f"{unit.mass_center_height:.3f} m", source
    inertia = ", ".join(f"{value:,.0f}" for value in unit.inertia.diagonal())
    source = solids if unit._spread is None else "set by the user"
    yield "roll, pitch, yaw inertia", f"{inertia} kg m²", source
    parts = f"{unit.n_nodes:,} nodes, {unit.n_trusses:,} trusses, {len(unit.wheels)} wheels"
    yield "skin", parts, "meshed from the outline" if file is not None else _NO_SOURCE


def _sources_of(blocks: Any) -> str:
    return ", ".join(dict.fromkeys(one for block in blocks for one in block.source)) or _NO_SOURCE
