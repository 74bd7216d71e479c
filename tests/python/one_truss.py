"""The simplest vehicle: one stiff truss straight ahead of the mass centre."""

from __future__ import annotations

import numpy as np
from birm3d import Vehicle


def one_truss(mass_center_height: float, k_unloading: float = 1e6) -> Vehicle:
    """Return 1,000 kg with a node 1 m ahead: it meets what is higher than its line, or nothing."""
    return Vehicle.from_arrays(
        mass=1000.0,
        inertia=1000.0 * np.eye(3),
        nodes=[[1.0, 0.0, 0.0]],
        anchors=[[0.0, 0.0, 0.0]],
        k_initial=1e6,
        k_unloading=k_unloading,
        mass_center_height=mass_center_height,
    )
