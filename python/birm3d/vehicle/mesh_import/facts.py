"""What a user says of a vehicle beside its mesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ...base.checks import array
from ...units import Quantity, si
from ..combination_recipe import CombinationRecipe
from ..from_facts import unit_of
from ..read_recipe import read_preset
from ..scaling import sizes_given
from ..variants import VehicleVariants
from ..zone import positive

__all__ = ["HOLES", "MeshFacts"]

HOLES = ("refuse", "close", "wrap")
"""What to do about a skin with holes."""


@dataclass(frozen=True)
class MeshFacts:
    """Arguments of :meth:`birm3d.Vehicle.from_mesh`, in SI and checked by :meth:`given`."""

    path: Path
    mass: float
    kind: str | None
    like: VehicleVariants | None
    unit: str | None
    forward: str
    up: str
    holes: str | None
    parts: Sequence[int | str] | None
    without_parts: Sequence[int | str]
    clearance: float
    element_size: float | None
    wheelbase: float | None
    front_overhang: float | None
    wheel_radius: float | None
    track: float | None
    mass_center_height: float | None
    center_of_mass: npt.NDArray[np.float64] | None
    inertia: npt.NDArray[np.float64] | None
    use_densities: bool
    zones: Mapping[str, Mapping[str, Any]]
    core: Mapping[str, Mapping[str, Any]]
    name: str | None

    @staticmethod
    def given(
        path: str | Path, mass: Quantity, like: VehicleVariants | str | None, others: dict[str, Any]
    ) -> MeshFacts:
        """Return the facts as numbers.

        Raises
        ------
        ValueError
            Naming the argument that is out of range.
        """
        lengths = (
            "wheelbase",
            "front_overhang",
            "wheel_radius",
            "track",
            "mass_center_height",
            "element_size",
        )
        sizes = sizes_given(**{name: others.pop(name) for name in lengths})
        size = sizes["element_size"]
        if size is not None and not 0.01 <= size <= 1.0:
            raise ValueError(f"element_size must be 0.01 to 1 m, got {size:g}")
        clearance = si("clearance", others.pop("clearance"), "length")
        if not 0.0 <= clearance <= 2.0:
            raise ValueError(f"clearance must be 0 to 2 m, got {clearance:g}")
        if others["holes"] not in (None, *HOLES):
            raise ValueError(f"holes must be one of {', '.join(HOLES)}; got {others['holes']!r}")
        if (others["kind"] is None) == (like is None):
            got = "neither" if like is None else "both"
            raise ValueError(f"kind or like must be given, and not both, got {got}")
        center = others.pop("center_of_mass")
        if center is not None:
            center = array("center_of_mass", center, 3)
            if not np.isfinite(center).all():
                raise ValueError(f"center_of_mass must be finite, got {center.tolist()}")
            if sizes["mass_center_height"] is not None:
                raise ValueError(
                    "center_of_mass must not be given together with mass_center_height, got both"
                )
        inertia = _inertia(others.pop("inertia"))
        said = {
            "center_of_mass": center is not None,
            "inertia": inertia is not None,
            "mass_center_height": sizes["mass_center_height"] is not None,
        }
        if others["use_densities"] and (stated := [name for name, given in said.items() if given]):
            raise ValueError(
                f"use_densities must be False where {stated[0]} is given: both say where mass is; got True"
            )
        base = _preset(like) if isinstance(like, str) else like
        if base is not None and (len(base.units) != 1 or base._file is None):
            raise _no_base(base.name)
        return MeshFacts(
            path=Path(path),
            mass=positive("mass", si("mass", mass, "mass")),
            like=base,
            center_of_mass=center,
            inertia=inertia,
            clearance=clearance,
            zones=others.pop("zones") or {},
            core=others.pop("core") or {},
            **{**others, **sizes},
        )


def _preset(name: str) -> VehicleVariants:
    recipe = read_preset(name, None, 1.0)
    if isinstance(recipe, CombinationRecipe):
        raise _no_base(recipe.name)
    return unit_of(recipe)


def _no_base(name: str) -> ValueError:
    return ValueError(f"like must be a vehicle of one unit that has a file, got {name!r}")


def _inertia(value: npt.ArrayLike | None) -> npt.NDArray[np.float64] | None:
    """Return the inertia (3, 3) of a diagonal or a matrix, of a mass that could be built [kg m^2]."""
    if value is None:
        return None
    given = np.asarray(value)
    if given.shape == (3,):
        given = np.diag(given)
    given = array("inertia", given, 3, 3)
    if not np.isfinite(given).all():
        raise ValueError(f"inertia must be finite, got {given.tolist()}")
    if not np.allclose(given, given.T, rtol=1e-9, atol=1e-9 * np.abs(given).max()):
        raise ValueError(f"inertia must be symmetric, got {given.tolist()}")
    moments = 0.5 * np.trace(given) * np.eye(3) - given
    if not np.linalg.eigvalsh(moments).min() > 0.0:
        raise ValueError(
            "inertia must be that of a mass: of its principal values the sum of any two above the third, got "
            f"{np.linalg.eigvalsh(given).tolist()}"
        )
    return given
