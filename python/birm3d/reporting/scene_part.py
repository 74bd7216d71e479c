"""Scene and vehicle: what was run, and where its numbers come from."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .. import units
from ..barrier.text import barrier_text
from ..result.report import END_REASONS
from ..vehicle import Vehicle
from ..vehicle.zone import LAW_NUMBERS
from .blocks import Block, Caution, Section, Table, Text
from .figures import figure
from .study_case import Case

__all__ = ["scene_section", "vehicle_section"]

_ARRAYS = (
    "This vehicle was given as arrays: mass, inertia and stiffness of each truss by value. Nothing is known "
    "of the sources of its numbers."
)

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
        ("vehicle", f"{scene.vehicle.name}, {scene.vehicle.mass:,.1f} kg"),
        ("barrier", barrier_text(scene.barrier)),
        *_barrier_rows(case),
        (
            "impact speed",
            f"{scene.impact_speed:.3f} m/s ({scene.impact_speed / units.km_h:.1f} km/h, "
            f"{scene.impact_speed / units.mph:.1f} mph)",
        ),
        ("impact angle", f"{scene.impact_angle:g}° between the path and the barrier's line (90°: head-on)"),
        ("impact offset", f"{scene.impact_offset:g} m along the barrier's line"),
        ("yaw, roll at impact", f"{scene.impact_yaw:g}°, {scene.impact_roll:g}°"),
        ("kinetic energy at impact", f"{result.energy['kinetic'][0] / 1e3:,.1f} kJ"),
        ("ended", f"at {result.time[-1]:.4f} s: {END_REASONS[result.end_reason]}"),
    ]
    blocks: list[Block] = [
        figure(result.plot_plan(), "Plan view of the trajectory"),
        Table("Scene", ("", "value"), rows),
    ]
    return Section("Scene", "scene", blocks)


def _barrier_rows(case: Case) -> Iterator[tuple[str, str]]:
    barrier = case.result.scene.barrier
    if barrier is None:
        return
    stands = "free-standing segments" if len(barrier.core.segments) else "fixed: it does not move"
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
    yield Table(f"{unit.name}: facts", ("", "value"), list(_facts(unit)))
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
                ", ".join(target.source),
            )
            for target in file.targets
        ]
        head = ("mass property", "value and band", "at a mass of", "status", "source")
        note = "The file's solids meet these bands."
        yield Table(f"{unit.name}: mass properties and their bands", head, rows, note=note)
    laws = {zone.name: zone for zone in file.zones}
    yield Table(
        f"{unit.name}: stiffness zones",
        ("zone", "law per unit of area", "status", "source"),
        [
            (name.replace("_", " "), _law(law), *_remarks(laws.get(name), law != file.laws.get(name)))
            for name, law in unit.zones.items()
        ],
    )
    sources = [(source.id, source.text, source.status) for source in file.sources]
    yield Table(f"{unit.name}: sources", ("id", "source", "status"), sources)


def _plain(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:.4g}"


def _remarks(zone: Any, changed: bool) -> tuple[str, str]:
    """Return status and sources of a zone; of one that is not the file's that it was changed."""
    if zone is None:
        return "", ""
    if changed:
        return "changed", f"scaled or set by the user; file: {', '.join(zone.source)}"
    return zone.status, ", ".join(zone.source)


_SHOWN = {
    "pressure per length": (1e6, "MPa/m"),
    "pressure": (1e6, "MPa"),
    "length": (1.0, "m"),
    "force": (1e3, "kN"),
    "number": (1.0, ""),
}
"""Quantity of a number of a law -> size in SI of the unit that the report shows, and that unit."""


def _law(law: Any) -> str:
    parts = []
    for name, value in law.items():
        if name == "envelope":
            points = ", ".join(f"{d:.4g} m: {stress / 1e6:.3g} MPa" for d, stress in value)
            parts.append(f"points {points}")
        elif value is not None:
            row = LAW_NUMBERS[name]
            size, unit = _SHOWN[row.quantity]
            parts.append(f"{row.words} {value / size:.4g} {unit}".rstrip())
    return "; ".join(parts)


def _facts(unit: Vehicle) -> Iterator[tuple[str, str]]:
    yield "mass", f"{unit.mass:,.1f} kg"
    if unit.kind is not None:
        yield "kind", unit.kind.replace("_", " ")
    for name in ("length", "width", "height", "wheelbase", "track"):
        size = getattr(unit, name)
        if size is not None:
            yield name, f"{size:.3f} m"
    yield "mass centre above the ground", f"{unit.mass_center_height:.3f} m"
    inertia = ", ".join(f"{value:,.0f}" for value in unit.inertia.diagonal())
    yield "roll, pitch, yaw inertia", f"{inertia} kg m²"
    yield "skin", f"{unit.n_nodes:,} nodes, {unit.n_trusses:,} trusses, {len(unit.wheels)} wheels"
