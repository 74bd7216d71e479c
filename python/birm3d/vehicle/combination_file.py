"""Strict reader of the files of articulated vehicles (TOML): two units, each a vehicle file, and their joint.

    [[unit]]
    file = "units/semi_tractor.toml"    # beside this file; the leading unit first

    [[unit]]
    file = "units/semi_trailer.toml"

    [joint]
    kind = "fifth_wheel"                # or "welded", or "sliding"
    place_on_leading_m = [-5.635, 0.0, 1.20]
    place_on_trailing_m = [0.0, 0.0, 1.20]
    roll_limit_deg = 2.0                # of a fifth wheel
    # slide_m_N = [[0.0, 6e5], [0.1, 0.0]]  # of a sliding joint: slip and the force held there
    source = ["..."]
    status = "estimated"

Head and sources are those of any vehicle file. Places are in the axes of each unit's own file. In place of
the key ``file`` a unit may have all blocks of its vehicle file, as ``[[unit.solid]]``: so
:meth:`birm3d.Vehicle.save` writes one file for both.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from ..io.file_format import reads
from ..io.toml import KeyPath, Strict, frozen, reject
from .file_schema import Block, Point, Positive, Source, Text, check_known, check_slide
from .joint import JointKind
from .vehicle_file import VehicleFile, VehicleFileError, ZonesInOrder, read_vehicle_file
from .zone_law import NonNegative

__all__ = ["Combination", "CombinationFile", "JointBlock", "UnitReference", "read_combination"]

# Heights of the two places of a joint may differ by this much, m: see Joint.
_FIT = 1e-3
# The units must add up to the stated weight within this share; the rest is a typing error.
_MASS = 0.01


class UnitReference(Strict):
    """A unit of the vehicle: its file, relative to the file that names it."""

    file: Annotated[str, Field(min_length=1)]


class JointBlock(Block):
    """How the trailing unit is attached to the leading one; see :class:`birm3d.Joint`."""

    kind: JointKind
    place_on_leading_m: Point
    place_on_trailing_m: Point
    roll_limit_deg: Annotated[float, Field(ge=0.0, lt=90.0)] | None = None
    slide_m_N: tuple[tuple[NonNegative, NonNegative], ...] = ()  # noqa: N815 - units in the key

    @model_validator(mode="after")
    def _check(self) -> JointBlock:
        leading, trailing = self.place_on_leading_m[2], self.place_on_trailing_m[2]
        if not abs(leading - trailing) <= _FIT:
            message = f"must be as high as on the leading unit, {leading} m within {_FIT} m; got {trailing}"
            reject("place_on_trailing_m", message)
        if self.kind == "fifth_wheel" and self.roll_limit_deg is None:
            reject("roll_limit_deg", "must be given for a fifth wheel")
        if self.kind == "sliding" and not self.slide_m_N:
            reject("slide_m_N", "must be given for a sliding joint")
        if self.slide_m_N:
            check_slide(self.slide_m_N)
        return self


class CombinationFile(Strict):
    """A vehicle of two units as its file describes it."""

    format_version: Literal[1]
    name: Text
    title: Text
    description: Text
    gvw_kg: Positive
    sources: Annotated[tuple[Source, ...], Field(alias="source", min_length=1)]
    units: Annotated[tuple[UnitReference | VehicleFile, ...], Field(alias="unit", min_length=2, max_length=2)]
    joint: JointBlock

    @model_validator(mode="after")
    def _check(self) -> CombinationFile:
        check_known("joint.source", self.joint.source, {source.id for source in self.sources})
        return self


class Combination(Strict):
    """A file of two units with the files that it names."""

    file: CombinationFile
    units: tuple[VehicleFile, VehicleFile]


@reads("must be a file of two units", VehicleFileError)
def read_combination(path: str | Path) -> Combination | None:
    """Read and check a file of two units and theirs; ``None`` for a file that names no units.

    Raises
    ------
    VehicleFileError
        With file, line, key, limit and value of everything that is wrong.
    """
    document = ZonesInOrder(Path(path))
    if "unit" not in document.data:
        return None
    data = frozen(document.data)
    if isinstance(data["unit"], tuple):
        data["unit"] = tuple(_unit(document, i, unit) for i, unit in enumerate(data["unit"]))
    file = document.validate(CombinationFile, data)
    leading, trailing = (
        unit if isinstance(unit, VehicleFile) else read_vehicle_file(document.path.parent / unit.file)
        for unit in file.units
    )
    total = leading.gvw_kg + trailing.gvw_kg
    if abs(total - file.gvw_kg) > _MASS * file.gvw_kg:
        limit = f"within {_MASS:.0%} of the units' masses, {total:.2f}"
        raise document.fault(("gvw_kg",), f"gvw_kg: must be {limit}, got {file.gvw_kg}")
    for zone in trailing.zone_names:
        if zone in leading.zone_names:
            message = f"names of zones must differ between the units, got '{zone}' in both"
            raise document.fault(("unit",), f"unit: {message}")
    return Combination(file=file, units=(leading, trailing))


def _unit(document: ZonesInOrder, i: int, unit: Any) -> Any:
    """Return a unit as it stands in the file, checked; what is no table is left for the whole to refuse."""
    at: KeyPath = ("unit", i)
    if not isinstance(unit, dict):
        return unit
    if "name" not in unit:
        return document.validate(UnitReference, unit, at)
    return document.validate(VehicleFile, document.zones_in_order(at), at)
