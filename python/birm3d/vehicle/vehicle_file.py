"""Strict reader of the vehicle file format (TOML).

A vehicle file holds dimensions, mass-carrying solids, wheels, the profile of the exterior shell, the rigid
core and the stiffness of the named zones. Everything is in SI, in file axes: x forward, y left, z up, origin
on the ground below the middle of the front axle. Every numeric block cites the sources of its numbers.

What is wrong in a file is reported with file, line, key, limit and the value received. Nothing is defaulted
silently: unknown keys, NaN and text where a number belongs are errors.
"""

# Longer than 300 lines: one file format: its schema as a whole, its reader, and what files extend.
from __future__ import annotations

import os
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import numpy as np
from pydantic import Field, field_validator, model_validator

from ..base.deprecated import warn_deprecated
from ..base.near_names import did_you_mean
from ..io.file_format import reading
from ..io.toml import Document, DocumentError, KeyPath, Strict, frozen, plain, received, reject
from .file_schema import (
    Assumption,
    Bed,
    Block,
    CoreBox,
    Dimensions,
    End,
    Exterior,
    Indentation,
    Kind,
    Name,
    NamedPoint,
    Overhang,
    Panel,
    Positive,
    Scaled,
    Scatter,
    Solid,
    Source,
    Target,
    Text,
    Upper,
    Wheel,
    Zone,
    check_known,
    check_unique,
)
from .old_keys import OLD_KEYS, with_todays_keys
from .resize import Resize, extent_of
from .scaling import Extent, Factors, Scaling, panel_factors
from .vehicle_changes import Changes
from .zone import Zone as LawOfZone

__all__ = [
    "Block",
    "CoreBox",
    "Dimensions",
    "End",
    "Exterior",
    "Solid",
    "Source",
    "Target",
    "Upper",
    "VehicleFile",
    "VehicleFileError",
    "Wheel",
    "Zone",
    "ZonesInOrder",
    "data_state",
    "laws_left",
    "preset_names",
    "preset_path",
    "read_vehicle_file",
    "unit_paths",
]

# The solids must add up to the stated vehicle weight within this share; the rest is a typing error.
_MASS = 0.01
_SAME_SIZE = Scaling()
# Blocks that a file with a block [scaled] replaces one by one.
_NAMED = ("solid", "wheel", "point", "core")


class VehicleFileError(DocumentError):
    """A vehicle file that can not be used; the message gives file, line, key, limit and value."""


class VehicleFile(Strict):
    """A vehicle as its file describes it: SI units, file axes, immutable.

    kind: what standards call it, as "pickup"; they may not know a vehicle without one.
    zones_at_kg: mass of the vehicle that the stiffness of the zones holds for; without it, gvw_kg.
    changes: how the vehicle differs from what the rest describes, see :meth:`birm3d.Vehicle.save`.
    """

    format_version: Literal[1]
    name: Name
    title: Text
    description: Text
    kind: Kind | None = None
    gvw_kg: Positive
    zones_at_kg: Positive | None = None
    sources: Annotated[tuple[Source, ...], Field(alias="source", min_length=1)]
    dimensions: Dimensions
    targets: Annotated[tuple[Target, ...], Field(alias="target")] = ()
    solids: Annotated[tuple[Solid, ...], Field(alias="solid", min_length=1)]
    wheels: Annotated[tuple[Wheel, ...], Field(alias="wheel")] = ()
    points: Annotated[tuple[NamedPoint, ...], Field(alias="point")] = ()
    exterior: Exterior
    overhang: Overhang | None = None
    bed: Bed | None = None
    indentation: Indentation | None = None
    core: Annotated[tuple[CoreBox, ...], Field(min_length=1)]
    zones: Annotated[tuple[Zone, ...], Field(alias="zone", min_length=1)]
    scatter: tuple[Scatter, ...] = ()
    assumptions: Annotated[tuple[Assumption, ...], Field(alias="assumption")] = ()
    changes: Changes | None = None

    @field_validator("core", "solids", "wheels", "points", "scatter", "sources")
    @classmethod
    def _names_differ(cls, items: tuple[Any, ...]) -> tuple[Any, ...]:
        names = [item.id if isinstance(item, Source) else item.name for item in items]
        check_unique("", names)
        return items

    @model_validator(mode="after")
    def _check(self) -> VehicleFile:
        if abs(self.solids_mass - self.gvw_kg) > _MASS * self.gvw_kg:
            limit = f"within {_MASS:.0%} of the solids' mass, {self.solids_mass:.2f}"
            reject("gvw_kg", f"must be {limit}, got {self.gvw_kg}")
        blocks = set(self.exterior.blocks)
        boxes, laws = {box.name for box in self.core}, set(self.law_names)
        for zone in self.zones:
            check_known(f"zone.{zone.name}.blocks", zone.blocks, blocks)
            check_known(f"zone.{zone.name}.core", zone.core, boxes)
        for i, one in enumerate(self.scatter):
            check_known(f"scatter.{i}.zones", one.zones, laws)
        self._check_cores()
        self._check_overhang()
        self._check_bed()
        for name in () if self.changes is None else self.changes.zone:
            check_known(f"changes.zone.{name}", (name,), laws)
        known = {source.id for source in self.sources}
        for key, block in self._blocks():
            check_known(f"{key}.source", block.source, known)
        return self

    def _check_cores(self) -> None:
        """Require a truss to start from every box: a zone lists it, or lists none."""
        zones = [zone for zone in self.zones if "tire" not in zone.panels]
        if any(not zone.core for zone in zones):
            return
        listed = {name for zone in zones for name in zone.core}
        for i, box in enumerate(self.core):
            if box.name not in listed:
                reject(
                    f"core.{i}.name",
                    f"must be in the list 'core' of a zone, or the box has no effect; got '{box.name}'",
                )

    def _check_overhang(self) -> None:
        """Require the step to leave some of the body."""
        if self.overhang is None:
            return
        if self.exterior.mesh is not None:
            reject("overhang", "must not go with exterior.mesh, which has the underside of the skin")
        x, _, bottoms, tops = np.array(self.exterior.stations_m)[::-1].T
        low, high = self.overhang.x_m
        there = [low, *x[(low < x) & (x < high)], high]
        bottom, top = np.interp(there, x, bottoms).max(), np.interp(there, x, tops).min()
        if not bottom < self.overhang.z_m < top:
            limit = f"between underside and upper edge of the body there, {bottom:g} and {top:g} m"
            reject("overhang.z_m", f"must be {limit}, got {self.overhang.z_m:g}")

    def _check_bed(self) -> None:
        """Require all that goes with the bed to be in the file, and some solids to stay."""
        if (bed := self.bed) is None:
            return
        check_known("bed.solids", bed.solids, {solid.name for solid in self.solids})
        check_known("bed.points", bed.points, {point.name for point in self.points})
        check_known("bed.block", (bed.block,), {upper.name for upper in self.exterior.upper})
        check_known("bed.underside", (bed.underside,), {zone.name for zone in self.zones})
        if not any(zone.blocks == (bed.block,) for zone in self.zones):
            reject("bed.block", f"must have a zone of its own, got '{bed.block}' without one")
        if len(set(bed.solids)) == len(self.solids):
            reject("bed.solids", "must leave solids for the chassis, got all")

    def _blocks(self) -> Iterator[tuple[str, Block]]:
        yield "dimensions", self.dimensions
        yield "exterior", self.exterior
        others = (("overhang", self.overhang), ("bed", self.bed), ("indentation", self.indentation))
        for name, block in others:
            if block is not None:
                yield name, block
        groups: Mapping[str, tuple[Block, ...]] = {
            "target": self.targets,
            "solid": self.solids,
            "wheel": self.wheels,
            "point": self.points,
            "core": self.core,
            "scatter": self.scatter,
        }
        for key, items in groups.items():
            for i, item in enumerate(items):
                yield f"{key}.{i}", item
        for zone in self.zones:
            yield f"zone.{zone.name}", zone
            for name, second in zone.second_laws.items():
                yield f"zone.{name}", second

    @property
    def solids_mass(self) -> float:
        """Sum of the solids' masses in kg, before they are scaled to a gross vehicle weight."""
        return sum(solid.mass for solid in self.solids)

    @property
    def zones_mass(self) -> float:
        """Mass of the vehicle that the zones' stiffness holds for [kg]."""
        return self.gvw_kg if self.zones_at_kg is None else self.zones_at_kg

    @cached_property
    def extent(self) -> Extent:
        """Where skin, wheels and core end."""
        return extent_of(self.exterior, self.wheels, self.core)

    def law_factors(self, mass: float, scaling: Scaling) -> dict[str, Factors]:
        """Return by which factors the laws go when the vehicle is scaled to a mass [kg], by their names."""
        strength = mass / self.zones_mass
        panels = {name: panel_factors(scaling, self.extent, name) for name in (*get_args(Panel), "along")}
        factors = {}
        for zone in self.zones:
            factors[zone.name] = Factors.mean(panels[name] for name in zone.panels)
            factors[zone.across_name] = panels["side"]
            factors[zone.along_name] = panels["along"]
        return {name: one._replace(stress=strength * one.stress) for name, one in factors.items()}

    def scaled_to(
        self,
        mass: float,
        scaling: Scaling = _SAME_SIZE,
        solids: float | None = None,
        known: Collection[str] = (),
    ) -> VehicleFile:
        """Return the file of a vehicle of another mass [kg] and size (:mod:`birm3d.vehicle.scaling`).

        Masses of the solids go in proportion, or to another sum [kg] than the zones. Targets are left out, as
        they are not met any more; so is what was assumed of dimensions that are known now, and their scatter.
        """
        solids = mass if solids is None else solids
        to = Resize(scaling, self.extent, solids / self.gvw_kg)
        factors = self.law_factors(mass, scaling)
        changes: dict[str, Any] = {
            "gvw_kg": solids,
            "zones_at_kg": mass,
            "targets": (),
            "scatter": tuple(one for one in self.scatter if one.name not in known),
            "assumptions": tuple(one for one in self.assumptions if one.quantity not in known),
            "solids": tuple(to.solid(solid) for solid in self.solids),
            "wheels": tuple(to.wheel(wheel) for wheel in self.wheels),
            "points": tuple(to.point(point) for point in self.points),
            "core": tuple(to.core(box) for box in self.core),
            "zones": tuple(to.zone(zone, factors) for zone in self.zones),
            "dimensions": to.dimensions(self.dimensions),
            "exterior": to.exterior(self.exterior),
            "overhang": to.overhang(self.overhang),
            "bed": to.bed(self.bed),
            "indentation": to.indentation(self.indentation),
        }
        return self.changed(changes)

    @property
    def laws(self) -> dict[str, LawOfZone]:
        """Laws of the zones by their names, in order, then their second ones: ``door.along``."""
        second = {name: one.law for zone in self.zones for name, one in zone.second_laws.items()}
        return {**{zone.name: zone.law for zone in self.zones}, **second}

    @property
    def law_names(self) -> tuple[str, ...]:
        """Names of the laws, in the order of :attr:`laws`."""
        return (*self.zone_names, *(name for zone in self.zones for name in zone.second_laws))

    @property
    def zone_names(self) -> tuple[str, ...]:
        """Names of the zones in the order in which they are matched."""
        return tuple(zone.name for zone in self.zones)


class ZonesInOrder(Document):
    """A file whose zones are a table, at its top or in each of its units; as a model they are a sequence."""

    error = VehicleFileError

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.data = self._renamed(self.data, ())
        if isinstance(units := self.data.get("unit"), list):
            self.data["unit"] = [
                self._renamed(unit, ("unit", i)) if isinstance(unit, dict) else unit
                for i, unit in enumerate(units)
            ]

    def _renamed(self, block: dict[str, Any], at: KeyPath) -> dict[str, Any]:
        """Return a block with the keys of today, each at the place of the old one; warn of those."""
        block, old = with_todays_keys(block)
        write = []
        for key in old:
            path, line = self._written((*at, *key))
            write.append(f"{'.'.join(OLD_KEYS[key])} for {'.'.join(key)} (line {line})")
            for written, where in list(self._places.items()):
                if written[: len(at) + len(key)] == (*at, *key):
                    self._places[(*at, *OLD_KEYS[key], *written[len(at) + len(key) :])] = where
        if write:
            warn_deprecated(f"{path}: keys have new names: write {', '.join(write)}")
        return block

    def zones_in_order(self, at: KeyPath = ()) -> Any:
        """Return the data of a block with the table of zones as a sequence, each with its name."""
        data = frozen(self._at(at))
        if isinstance(table := data.get("zone"), dict):
            for name, block in table.items():
                if not isinstance(block, dict) or "name" in block:
                    place = self.place((*at, "zone", name, "name"))
                    message = f"must be a table without the key 'name', got {received(block)}"
                    raise VehicleFileError(f"{place}: zone.{name}: {message}")
            data["zone"] = tuple({"name": name, **block} for name, block in table.items())
        return data

    def written_key(self, key: KeyPath) -> KeyPath:
        """Zones are a table in the file: their place in the sequence is their name there."""
        for i, part in enumerate(key[:-1]):
            number = key[i + 1]
            if part == "zone" and isinstance(number, int):
                return (*key[: i + 1], list(self._at(key[: i + 1]))[number], *key[i + 2 :])
        return key

    def _at(self, key: KeyPath) -> Any:
        block: Any = self.data
        for part in key:
            block = block[part]
        return block


class _VehicleDocument(ZonesInOrder):
    """A vehicle file with what it extends merged in."""

    def __init__(self, path: Path, parents: tuple[Path, ...] = ()) -> None:
        if path.resolve() in parents:
            raise VehicleFileError.at(path, None, "extends: the files extend each other in a circle")
        super().__init__(path)
        if "extends" in self.data:
            self._extend(parents)

    def _extend(self, parents: tuple[Path, ...]) -> None:
        name = self.data.pop("extends")
        if not isinstance(name, str):
            reason = f"extends: must be a preset or a file name, got {received(name)}"
            raise self.fault(("extends",), reason)
        target = preset_path(name) if name in preset_names() else self.path.parent / name
        base = _VehicleDocument(target, (*parents, self.path.resolve()))
        if "without" in self.data:
            self._leave_out(base)
        if "scaled" in self.data:
            self._scale(base)
        own = self.data
        if "exterior" in own or "overhang" in own:
            base.data.pop("bed", None)  # another outline needs another bed
        merged = {**base.data, **own}
        shift = 0
        zones: dict[str, Any] = {}
        if isinstance(own.get("source"), list) and isinstance(base.data.get("source"), list):
            shift = len(own["source"])
            merged["source"] = own["source"] + base.data["source"]
        if isinstance(own.get("zone"), dict) and isinstance(base.data.get("zone"), dict):
            zones = own["zone"]
            new = {key: value for key, value in zones.items() if key not in base.data["zone"]}
            merged["zone"] = {**new, **base.data["zone"], **zones}  # new zones are matched first
        for key, where in base._places.items():
            if key[:1] == ("source",) and shift and len(key) > 1 and isinstance(key[1], int):
                moved = ("source", key[1] + shift, *key[2:])
                self._places[moved] = where
            elif key[:1] == ("zone",) and zones:
                if len(key) > 1 and key[1] not in zones:
                    self._places[key] = where
            elif key and key[0] not in own:
                self._places[key] = where
        self.data = merged

    def _leave_out(self, base: _VehicleDocument) -> None:
        """Leave out zones of the vehicle that the file extends, as the list "without" says."""
        without = self.data.pop("without")
        if not isinstance(without, list):
            raise self.fault(("without",), f"without: must be a list of zones, got {received(without)}")
        base.data["zone"] = self._zones_left(("without",), without, base.data["zone"])
        base.data["scatter"] = _scatter_of(base.data)

    def _zones_left(
        self, at: KeyPath, without: Sequence[Any], zones: dict[str, Any], others: Iterable[str] = ()
    ) -> dict[str, Any]:
        """Return the zones that a list leaves; it may name zones, as "zone.hood", and the others."""
        known = sorted([*others, *(f"zone.{name}" for name in zones)])
        for name in without:
            if name not in known:
                reason = f"{'.'.join(map(str, at))}: must be one of {', '.join(known)}; got {received(name)}"
                raise self.fault(at, reason)
        return {name: zone for name, zone in zones.items() if f"zone.{name}" not in without}

    def _scale(self, base: _VehicleDocument) -> None:
        """Scale the vehicle that the file extends, as the block "scaled" says."""
        scaled = self.validate(Scaled, frozen(self.data.pop("scaled")), ("scaled",))
        file = base.validate(VehicleFile, base.zones_in_order())
        if file.changes is not None:
            raise self.fault(("scaled",), "scaled: must extend a vehicle without a block [changes]")
        try:
            scaling = scaled.scaling_of(file.extent, file.name)
        except ValueError as error:
            raise self.fault(("scaled",), f"scaled: {error}") from error
        data = plain(file.scaled_to(scaled.mass_kg, scaling, scaled.solids_kg))
        names = {block["name"] for key in _NAMED for block in data.get(key, ())}
        zones = {zone.pop("name"): zone for zone in data["zone"]}
        data["zone"] = self._zones_left(("scaled", "without"), scaled.without, zones, names)
        data["scatter"] = _scatter_of(data)
        for key in _NAMED:
            data[key] = [block for block in data.get(key, ()) if block["name"] not in scaled.without]
            if isinstance(self.data.get(key), list):
                self._merge(key, data[key])
        if scaled.element_size_m is not None:
            data["exterior"]["element_size_m"] = scaled.element_size_m
        origin = {"source": list(scaled.source), "status": scaled.status}
        data["dimensions"] = {**data["dimensions"], **origin}
        base.data = data

    def _merge(self, key: str, base: list[dict[str, Any]]) -> None:
        """Put the file's own named blocks in the place of those of the same name, or behind them all."""
        merged, names = list(base), [block["name"] for block in base]
        written = {at: where for at, where in self._places.items() if at[:1] == (key,) and len(at) > 1}
        for at in written:
            del self._places[at]
        for i, block in enumerate(self.data[key]):
            name = block.get("name") if isinstance(block, dict) else None
            place = names.index(name) if name in names else len(merged)
            merged[place : place + 1] = [block]
            for at, where in written.items():
                if at[1] == i:
                    self._places[(key, place, *at[2:])] = where
        self.data[key] = merged


def _scatter_of(data: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the scatter of a class without zones that were left out, nor blocks of such zones alone."""
    return [
        {**block, "zones": left}
        for block in data.get("scatter", ())
        if (left := laws_left(block.get("zones", ()), data["zone"])) is not None
    ]


def laws_left(names: Collection[str], zones: Container[str]) -> tuple[str, ...] | None:
    """Return which laws that a block of scatter names are those of zones; ``None`` if all are of others."""
    left = tuple(name for name in names if name.partition(".")[0] in zones)
    return left if left or not names else None


def read_vehicle_file(path: str | Path) -> VehicleFile:
    """Read and check a vehicle file.

    Parameters
    ----------
    path
        TOML file. With ``extends = "pickup"`` (a preset, or a file beside it) it states only what differs.
        Its top-level keys replace those of that vehicle, its zones replace zones one by one, and its sources
        are added. New zones are matched first. ``without = ["zone.engine"]`` leaves zones of that vehicle
        out. With a block ``[scaled]`` the vehicle extended is scaled before that.

    Raises
    ------
    VehicleFileError
        With file, line, key, limit and value of everything that is wrong.
    """
    document = _VehicleDocument(Path(path))
    with reading(path, "must be a vehicle file", VehicleFileError):
        return document.validate(VehicleFile, document.zones_in_order())


# The weights of the paper, its replication target, then the vehicles of the standards by weight.
_ORDER = (
    *("passenger_car", "minivan", "pickup", "cargo_truck", "semi_truck", "paper_pickup"),
    *("small_car", "mash_1100c", "sedan_1500", "mash_2270p", "pickup_4x4_2500", "heavy_pickup", "van_3500"),
    *("cabover_7200", "cabover_7500", "mash_10000s", "bus_13t", "heavy_truck_29500", "mash_36000v"),
)
_TWO_UNITS = ("semi_truck", "mash_36000v")


def preset_names() -> tuple[str, ...]:
    """Names of the vehicle files that come with the package, in the order of the docs."""
    folder = resources.files("birm3d") / "data"
    names = {f.name.removesuffix(".toml") for f in folder.iterdir() if f.name.endswith(".toml")}
    return (*(name for name in _ORDER if name in names), *sorted(names.difference(_ORDER)))


def preset_path(name: str) -> Path:
    """Path of the vehicle file of a preset."""
    known = preset_names()
    if name not in known:
        raise ValueError(f"preset must be one of {', '.join(known)}; got {name!r}{did_you_mean(name, known)}")
    return Path(str(resources.files("birm3d") / "data" / f"{name}.toml"))


def data_state() -> tuple[tuple[str, int, int], ...]:
    """Names, instants of change and sizes of all vehicle files that come with the package."""
    folder = str(resources.files("birm3d") / "data")
    files = [file for place in (folder, f"{folder}/units") for file in os.scandir(place)]
    states = ((file.path, file.stat()) for file in files if file.name.endswith(".toml"))
    return tuple(sorted((path, state.st_mtime_ns, state.st_size) for path, state in states))


def unit_paths() -> dict[str, Path]:
    """Files of one unit that come with the package, by their names: presets, and the units of the others."""
    folder = Path(str(resources.files("birm3d") / "data"))
    units = {path.stem: path for path in sorted((folder / "units").glob("*.toml"))}
    single = {name: preset_path(name) for name in preset_names() if name not in _TWO_UNITS}
    return {**single, **units}
