"""Histories of one rigid body of a vehicle."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.arguments import checked
from .stored import Stored

__all__ = ["UnitResult", "read_only"]

Floats = npt.NDArray[np.float64]


@checked
class UnitResult:
    """Histories of n rows of one unit; what is said of :class:`birm3d.Result` holds.

    Attributes
    ----------
    nodes, deflection, peak_deflection : ndarray
        Shell nodes in body axes (k, 3), truss deflections (k,) at the end and their peaks [m].
    final_velocity : ndarray, shape (3,)
        Of the mass centre at the end, world axes [m/s].
    """

    def __init__(
        self,
        history: _core.UnitHistory | Stored,
        *,
        nodes: Floats,
        deflection: Floats,
        peak_deflection: Floats,
        final_velocity: Floats,
    ) -> None:
        self.nodes = nodes
        self.deflection = deflection
        self.peak_deflection = peak_deflection
        self.final_velocity = final_velocity
        self._unit = history

    @property
    def position(self) -> Floats:
        """Mass centre, world axes, shape (n, 3) [m]."""
        return self._unit.position

    @property
    def velocity(self) -> Floats:
        """Of the mass centre, world axes, shape (n, 3) [m/s]."""
        return self._unit.velocity

    @property
    def acceleration(self) -> Floats:
        """Of the mass centre, body axes r, s, t, shape (n, 3) [m/s^2]; interval means."""
        return self._unit.acceleration

    @property
    def angular_velocity(self) -> Floats:
        """Body axes r, s, t, shape (n, 3) [deg/s]."""
        return read_only(np.degrees(self._unit.angular_velocity))

    @cached_property
    def _angles(self) -> Floats:
        angles = np.unwrap(self._unit.roll_pitch_yaw, axis=0)
        angles[:, 2] -= angles[0, 2]
        return read_only(np.degrees(angles))

    @property
    def roll(self) -> Floats:
        """About r, shape (n,) [deg]."""
        return self._angles[:, 0]

    @property
    def pitch(self) -> Floats:
        """About s, positive nose-down, shape (n,) [deg]."""
        return self._angles[:, 1]

    @property
    def yaw(self) -> Floats:
        """About t, from the initial heading, positive to the left, shape (n,) [deg]."""
        return self._angles[:, 2]

    @property
    def barrier_force(self) -> Floats:
        """Of the barrier on the unit, world axes, shape (n, 3) [N]; interval means."""
        return self._unit.barrier_force

    @property
    def barrier_normal_force(self) -> Floats:
        """Component of ``barrier_force`` along the barrier's normal, shape (n,) [N]; interval means.

        See :attr:`birm3d.Result.barrier_normal_force`.
        """
        return self._unit.barrier_normal_force

    @property
    def sum_of_contact_forces(self) -> Floats:
        """Sum of the magnitudes of the normal forces of all its nodes, shape (n,) [N]; interval means.

        See :attr:`birm3d.Result.sum_of_contact_forces`.
        """
        return self._unit.sum_of_contact_forces

    @property
    def tire_reaction(self) -> Floats:
        """Normal force under each of its wheels, shape (n, wheels) [N]; interval means."""
        return self._unit.tire_reaction

    @property
    def tire_friction_force(self) -> Floats:
        """Of the ground on the unit, tangential, world axes, shape (n, 3) [N]; interval means."""
        return self._unit.tire_friction_force

    @property
    def ground_force(self) -> Floats:
        """Of the ground on its body, not the tyres, world axes, shape (n, 3) [N]; interval means."""
        return self._unit.ground_force

    @property
    def joint_force(self) -> Floats:
        """Of its joint on the unit, world axes, shape (n, 3) [N]; interval means; zero without a joint."""
        return self._unit.joint_force


def read_only(array: Any) -> Floats:
    """Return a read-only float64 array."""
    result: Floats = np.asarray(array, float)
    result.setflags(write=False)
    return result
