"""Occupant risk of an impact, computed or measured."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import overload

from ..base.arguments import checked
from ..result import Result
from ..result.run_warnings import complaints_of
from ..signals.channel import Channel
from ..study.predict import Prediction
from ..study.table import Study
from ..study.whole_runs import look_at_study
from ..units import Quantity, si
from .pulse import pulse_of_channels, pulse_of_result
from .risk_study import RiskStudy, risk_of_study
from .risk_values import CAUTION, OccupantRisk
from .vehicles import HEAVY_KG

__all__ = ["CAUTION", "OccupantRisk", "occupant_risk"]


@overload
def occupant_risk(
    result: Result | None = None,
    *,
    x: Channel | float | None = None,
    y: Channel | float | None = None,
    z: Channel | float | None = None,
    yaw_rate: Channel | float | None = None,
    time_zero: Quantity = 0.0,
    head_x: Quantity | None = None,
    point: str | Sequence[Quantity] = "mass_center",
    part: str | int | None = None,
    edition: int = 2010,
) -> OccupantRisk: ...


@overload
def occupant_risk(
    result: Study | Prediction,
    *,
    head_x: Quantity | None = None,
    point: str | Sequence[Quantity] = "mass_center",
    part: str | int | None = None,
    edition: int = 2010,
) -> RiskStudy: ...


@checked
def occupant_risk(
    result: Result | Study | Prediction | None = None,
    *,
    x: Channel | float | None = None,
    y: Channel | float | None = None,
    z: Channel | float | None = None,
    yaw_rate: Channel | float | None = None,
    time_zero: Quantity = 0.0,
    head_x: Quantity | None = None,
    point: str | Sequence[Quantity] = "mass_center",
    part: str | int | None = None,
    edition: int = 2010,
) -> OccupantRisk | RiskStudy:
    """Return occupant risk of a computed run, of the runs of a study, or of measured channels.

    OIV and ridedown (MASH, NCHRP 350), ASI, THIV and PHD (EN 1317-1) and OLC, each with limit, class and
    verdict. Accelerations are taken as they are: standards ask for channels of CFC 180, see
    :meth:`birm3d.Channel.filtered`. Where the record ends after the acceleration has died away, the vehicle
    is taken to go on as it is.

    Parameters
    ----------
    result
        A run with a contact; time zero is its first touch. Of a study or a prediction every run is looked at,
        and each value has its band.
    x, y, z
        In place of a result: accelerations along the vehicle's own axes at its mass centre, forward, left,
        up; a braking vehicle has x below 0. ``0``: there was none. `z` is needed for ASI only.
    yaw_rate
        Positive to the left; needed for THIV and PHD only.
    time_zero
        Instant of the first contact in the channels' time [s].
    head_x
        Of the theoretical head before `point` at time zero [m]; ``None``: that of the vehicle's point
        ``driver_head``, if its file has one, else 0.
    point, part
        Of a result: where the gauges are, see :meth:`birm3d.Result.sensor`.
    edition
        Of EN 1317-1 that ``asi`` follows: 2010 or 1998.

    Raises
    ------
    ValueError
        If there is neither a result nor channels, or both. If a channel is missing, measures something else
        or does not hold time zero. If a channel changes the velocity by more than 0.3 m/s before time zero.
        If nothing is hit. If the record ends while the vehicle is still pushed.
    """
    channels = {"x": x, "y": y, "z": z, "yaw_rate": yaw_rate}
    if edition not in (1998, 2010):
        raise ValueError(f"edition of EN 1317-1 must be 1998 or 2010, got {edition}")
    if result is None:
        pulse = pulse_of_channels(channels, si("time_zero", time_zero, "time"))
        ahead = 0.0 if head_x is None else si("head_x", head_x, "length")
        return OccupantRisk(pulse, ahead, edition)
    given = [name for name, value in channels.items() if value is not None]
    if given:
        raise ValueError(f"{given[0]} must be None where a result is given, got both")

    def look(run: Result) -> OccupantRisk:
        pulse = pulse_of_result(run, point, part)
        ahead = _head_ahead(run, point, part, head_x)
        heavy = run.scene.vehicle.mass >= HEAVY_KG
        # Their texts alone are kept, not the scene that they are made of.
        told = [one._replace(text=partial(str, one.text()), advice=None) for one in complaints_of(run)]
        return OccupantRisk(pulse, ahead, edition, is_computed=True, is_heavy=heavy, complaints=told)

    if isinstance(result, Result):
        return look(result)
    study = result.study if isinstance(result, Prediction) else result
    return risk_of_study(*look_at_study(study, look, title="occupant risk"))


def _head_ahead(
    result: Result, point: str | Sequence[Quantity], part: str | int | None, head_x: Quantity | None
) -> float:
    """Return how far the head is before the gauges [m]."""
    if head_x is not None:
        return si("head_x", head_x, "length")
    gauges = result.sensor(point, part)
    unit = next(unit for unit in result.scene.vehicle.units if unit.name == gauges.part)
    head = unit.points.get("driver_head")
    return 0.0 if head is None else head[0] - float(gauges.point[0])
