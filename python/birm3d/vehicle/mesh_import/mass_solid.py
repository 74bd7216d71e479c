"""A solid that has a given mass, mass centre and inertia."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..file_schema import Solid
from .facts import MeshFacts
from .placing import rotation
from .raw_mesh import RawMesh

__all__ = ["OwnMass", "mass_of_deck", "solid_of"]

Floats = npt.NDArray[np.float64]
_BOX = ((-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1))


def solid_of(mass: float, center: Floats, inertia: Floats) -> Solid:
    """Return the uniform box with this mass [kg], mass centre (3,) [m] and inertia (3, 3) about it [kg m^2].

    A box with sides a along its own axes has the second moments m a^2 / 12. They are the principal values of
    J = trace(I) / 2 - I. So every inertia of a mass is that of exactly one box.
    """
    moments, axes = np.linalg.eigh(0.5 * np.trace(inertia) * np.eye(3) - inertia)
    # The axis nearest to x first, and so on; then each along its own, so that the corners keep their order.
    order = np.argmax(np.abs(axes), axis=1)
    if len(set(order.tolist())) < 3:
        order = np.array([2, 1, 0])
    moments, axes = moments[order], axes[:, order]
    axes = axes * np.where(np.diagonal(axes) < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        axes[:, 1] *= -1.0
    half = 0.5 * np.sqrt(12.0 * moments / mass)
    corners = center + (np.array(_BOX, float) * half) @ axes.T
    return Solid(
        name="vehicle",
        corners_m=tuple(tuple(corner) for corner in corners.tolist()),
        mass_kg=mass,
        source=("given",),
        status="measured",
    )


class OwnMass(NamedTuple):
    """Mass centre (3,) [m] and inertia (3, 3) about it [kg m^2], axes of the vehicle."""

    center: Floats
    inertia: Floats


def mass_of_deck(mesh: RawMesh, points: Floats, facts: MeshFacts, told: list[str]) -> OwnMass:
    """Return mass centre and inertia by the densities of a keyword file, brought to the mass that is given.

    Only ratios of its masses count, so that its unit of mass does not matter.

    Parameters
    ----------
    mesh
        As read.
    points
        Its points in the vehicle's axes, shape (n, 3) [m].
    facts
        With the mass.
    told
        What was assumed; gets a sentence.

    Raises
    ------
    MeshFileError
        If the file says nothing of masses, or holds no numbers where they should be.
    """
    try:
        lumps = None if mesh.mass is None else mesh.mass.lumps().of_parts(np.unique(mesh.part))
    except (ValueError, IndexError) as error:
        raise mesh.fault(f"densities and thicknesses must be numbers in their columns, {error}") from error
    if lumps is None or not lumps.mass.sum() > 0.0:
        raise mesh.fault(
            "use_densities must be False for a mesh without densities (*MAT) and thicknesses "
            "(*SECTION_SHELL), got True"
        )
    # The axes of the file to those of the vehicle: the map that took its points there.
    low, high = int(mesh.points[:, 0].argmin()), int(mesh.points[:, 0].argmax())
    scale = float(
        np.linalg.norm(points[high] - points[low]) / np.linalg.norm(mesh.points[high] - mesh.points[low])
    )
    axes = rotation(facts.forward, facts.up)
    total, center, inertia = lumps.properties()
    place = points[low] + scale * axes @ (center - mesh.points[low])
    silent = f"; without a known mass: parts {', '.join(map(str, lumps.silent[:8]))}" if lumps.silent else ""
    more = f" and {len(lumps.silent) - 8} more" if len(lumps.silent) > 8 else ""
    told.append(
        f"mass centre and inertia by densities and thicknesses of the file, {total:.5g} in its unit of mass, "
        f"brought to {facts.mass:,.5g} kg; beams, springs and rigid bodies of nodes have none{silent}{more}"
    )
    return OwnMass(place, axes @ inertia @ axes.T * scale**2 * facts.mass / total)
