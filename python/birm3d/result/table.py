"""Histories of a result as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .element_loads import touched_elements

if TYPE_CHECKING:
    import pandas as pd

    from .analysis import RunAnalysis

__all__ = ["to_dataframe"]


def to_dataframe(self: RunAnalysis) -> pd.DataFrame:
    """Return the histories as a table, one row an output instant, indexed by time [s].

    Of the elements of the barrier those that were touched have columns.
    """
    try:
        import pandas as pd
    except ImportError as error:
        raise ImportError("to_dataframe() needs pandas: pip install 'birm3d[table]'") from error
    columns: dict[str, npt.NDArray[np.float64]] = {}
    for name, unit, axes in (
        ("position", "m", "xyz"),
        ("velocity", "m/s", "xyz"),
        ("acceleration", "m/s^2", "rst"),
        ("barrier_force", "N", "xyz"),
    ):
        for i, axis in enumerate(axes):
            columns[f"{name}_{axis} [{unit}]"] = getattr(self, name)[:, i]
    for name in ("roll", "pitch", "yaw"):
        columns[f"{name} [deg]"] = getattr(self, name)
    columns["barrier_normal_force [N]"] = self.barrier_normal_force
    for load in touched_elements(self.element_loads):
        for i, axis in enumerate("xyz"):
            columns[f"{load.name}: force_{axis} [N]"] = load.force[:, i]
        for i, axis in enumerate("xyz"):
            columns[f"{load.name}: moment_{axis} [N m]"] = load.moment[:, i]
        columns[f"{load.name}: resultant_height [m]"] = load.resultant_height
    for i in range(self.tire_reaction.shape[1]):
        columns[f"tire_reaction_{i} [N]"] = self.tire_reaction[:, i]
    if self.scene.vehicle.joint is not None:
        for i, axis in enumerate("xyz"):
            columns[f"joint_force_{axis} [N]"] = self.joint_force[:, i]
        columns["articulation_angle [deg]"] = self.articulation_angle
    if self.scene.vehicle.slides:
        columns["bed_slip [m]"] = self.bed_slip
    for name, values in self.energy.items():
        columns[f"energy_{name} [J]"] = values
    return pd.DataFrame(columns, index=pd.Index(self.time, name="time [s]"))
