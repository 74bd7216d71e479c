"""What a vehicle has that is not in the blocks of its file: the block ``[changes]`` of a saved one.

A saved file has all blocks of the file that the vehicle comes from, with their sources. Its block
``[changes]`` says how the vehicle differs. The same vehicle comes back from it, bit for bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any, TypeAlias

from pydantic import AfterValidator, ConfigDict, Field, WrapSerializer, model_validator

from ..base.frozen_mapping import FrozenMapping
from ..io.toml import Strict
from .file_schema import LawName, Positive
from .zone_law import ZoneLaw

__all__ = ["ChangedLaw", "Changes"]


class ChangedLaw(ZoneLaw):
    """The law of a zone in place of the file's."""

    model_config = ConfigDict(allow_inf_nan=True)  # a knee may be infinitely far

    @model_validator(mode="after")
    def _check(self) -> ChangedLaw:
        self.require_law()
        return self


def _as_dict(laws: Mapping[str, ChangedLaw], write: Callable[[dict[str, ChangedLaw]], Any]) -> Any:
    return write(dict(laws))


# A table of the file, kept so that the vehicle is a value: it does not change, and it hashes.
LawsByName: TypeAlias = Annotated[
    Mapping[LawName, ChangedLaw], AfterValidator(FrozenMapping), WrapSerializer(_as_dict)
]


class Changes(Strict):
    """How a vehicle differs from the one that the other blocks of its file describe.

    gvw_kg: see :meth:`birm3d.Vehicle.with_gvw`; load_density_kg_per_m3: of its goods. mesh_density: number of
    elements relative to element_size_m. mass_center_height_m: in place of that of the solids, see
    :meth:`birm3d.Vehicle.with_mass_center_height`. mass_spread: factors of distances from the mass centre
    along x, y and z, see :meth:`birm3d.Vehicle.with_inertia`. tire_contact: whether tyres meet barriers.
    zone: laws in place of those of the file.
    """

    name: Annotated[str, Field(min_length=1)] | None = None
    gvw_kg: Positive | None = None
    load_density_kg_per_m3: Positive | None = None
    mesh_density: Positive = 1.0
    mass_center_height_m: Positive | None = None
    mass_spread: tuple[Positive, Positive, Positive] | None = None
    rate_sensitivity_s_per_m: Annotated[float, Field(ge=0.0)] = 0.0
    indentation_length_m: Annotated[float, Field(ge=0.0)] | None = None
    tire_contact: bool = True
    zone: LawsByName = FrozenMapping({})
