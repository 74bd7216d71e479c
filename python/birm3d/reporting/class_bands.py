"""How the vehicles of a class differ in the scene of a dossier: bands, and probabilities of ratings."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

from ..assessment import DesignLoad, OccupantRisk, Rating, RatingStudy, RiskStudy, occupant_risk, rate
from ..assessment.class_bands import Seen
from ..assessment.design_load import looker, with_vehicles
from ..assessment.probability import rating_study
from ..assessment.risk_study import risk_of_study
from ..result.metric_table import METRICS
from ..result.result import Result
from ..result.summary import HEADLINES, shown_as
from ..simulation import Simulation
from ..study.class_draws import parameter_of
from ..study.predict import Prediction
from ..study.predict_and_look import predict_and_look
from ..study.whole_runs import look_at_study
from ..vehicle.class_scatter import Z_80, joined
from .blocks import Block, Caution, Table, Text
from .shares import outcome_table

__all__ = ["ClassBands", "band_of", "class_bands", "class_blocks", "headline_table"]

_PARTS = {
    "front": "forces of the front",
    "side": "forces of the side",
    "corner": "forces of the corners",
    "tires": "forces of the tyres",
    "springs": "stiffness of the springs",
    "mass_center_height": "height of the mass centre",
    "barrier_friction": "friction of vehicle on barrier",
    "tire_friction": "friction of tyres on the ground",
    "edge_flank": "sideways force at a wall's rounded edge",
    "bed_fixings": "strength of the fixings of a load bed that slides",
    "length": "length",
    "width": "width",
    "height": "height",
    "wheelbase": "wheelbase",
    "roll_inertia": "roll inertia",
    "yaw_inertia": "yaw inertia",
}
_ROUNDING = 1e-6  # SI and degrees: values below are rounding errors


@dataclass(frozen=True)
class ClassBands:
    """What the vehicles of a class do in one scene.

    Attributes
    ----------
    prediction : Prediction
    ratings : mapping of str to RatingStudy
        Standard -> ratings of all vehicles.
    risk : RiskStudy or None
        ``None`` where the run itself has none.
    """

    prediction: Prediction
    ratings: Mapping[str, RatingStudy]
    risk: RiskStudy | None


def class_bands(
    result: Result,
    prediction: Prediction | None,
    draws: int,
    standards: Sequence[str],
    with_risk: bool,
    vehicle_class: str | None = None,
    loads: DesignLoad | None = None,
) -> ClassBands | str:
    """Return the bands of a run, or why there are none; each vehicle is run once.

    Parameters
    ----------
    prediction
        Of the scene; ``None``: one is made.
    draws
        Number of vehicles; 0: none.
    standards
        That rate the run.
    with_risk
        Whether the run has occupant risk.
    vehicle_class
        What the standards call the vehicle; ``None``: by its kind and mass.
    loads
        Design loads of the run without bands, which are given them.
    """
    if prediction is None and draws == 0:
        return "no vehicles of its class were drawn (draws=0)"
    rows = None if loads is None else looker(loads)
    look = partial(_look, standards=standards, with_risk=with_risk, vehicle_class=vehicle_class, loads=rows)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of vehicles that are not this one; the caution counts them
        if prediction is None:
            if not any(unit.scatter for unit in result.scene.vehicle.units):
                return "the vehicle's file does not say how its class scatters"
            simulation = Simulation.from_scene(result.scene)
            prediction, found, failed = predict_and_look(simulation, draws, look)
        else:
            found, failed = look_at_study(prediction.study, look, progress=False)
    ratings = {}
    for standard in standards:
        judged = {run: one.ratings[standard] for run, one in found.items() if standard in one.ratings}
        if judged:
            missing = {run: one.reasons[standard] for run, one in found.items() if run not in judged}
            ratings[standard] = rating_study(judged, {**failed, **missing})
    risks = {run: one.risk for run, one in found.items() if one.risk is not None}
    if loads is not None:
        seen = [(run, one.loads) for run, one in found.items()] + [(run, None) for run in failed]
        with_vehicles(loads, seen, len(prediction.study))
    return ClassBands(prediction, ratings, risk_of_study(risks, failed) if risks else None)


class _Seen(NamedTuple):
    """What was seen of one vehicle of the class, as far as it has it.

    reasons: standard -> why it does not rate the run.
    """

    ratings: dict[str, Rating]
    reasons: dict[str, str]
    risk: OccupantRisk | None
    loads: Seen | None


def _look(
    run: Result,
    standards: Sequence[str],
    with_risk: bool,
    vehicle_class: str | None,
    loads: Callable[[Result], Seen] | None,
) -> _Seen:
    """Return the ratings, the occupant risk and the loads of one vehicle of the class."""
    carried = None if loads is None else loads(run)
    ratings, reasons = {}, {}
    for standard in standards:
        try:
            ratings[standard] = rate(run, standard, vehicle_class=vehicle_class)
        except ValueError as reason:  # its outcome is not decided
            reasons[standard] = str(reason)
    try:
        return _Seen(ratings, reasons, occupant_risk(run) if with_risk else None, carried)
    except ValueError:  # it touches nothing
        return _Seen(ratings, reasons, None, carried)


def band_of(bands: ClassBands | str, name: str, size: float = 1.0, form: str = ".4g") -> str:
    """Return the 80 % band of a metric as text, in units of `size`; a dash where there is none."""
    if isinstance(bands, str) or name not in bands.prediction.low:
        return "–"
    low, high = (format(end[name] / size, form) for end in (bands.prediction.low, bands.prediction.high))
    return f"{low} to {high}"


def class_blocks(result: Result, bands: ClassBands | str) -> Iterator[Block]:
    """Yield what was drawn, and the bands of all metrics that say what happens."""
    if isinstance(bands, str):
        yield Text(f"There are no bands of the vehicle's class: {bands}.")
        return
    predicted = bands.prediction
    yield Text(
        f"Vehicles of one class differ. {len(predicted.study)} of them were run in this scene, with mass, "
        "speed, angle and barrier as given. This was drawn, each lognormal, as the vehicle's file says with "
        "its source:"
    )
    vehicle = result.scene.vehicle
    rows = []
    for name, one in joined([unit.scatter for unit in vehicle.units], vehicle.zones_met).items():
        if parameter_of(name) not in predicted.drawn:
            continue
        low, high = (one.median * math.exp(sign * Z_80 * one.log_sd) for sign in (-1.0, 1.0))
        rows.append((_PARTS[name], f"{one.median:.2f}", f"{low:.2f} to {high:.2f}"))
    head = ("quantity", "median factor on this vehicle's", "80 % of the class")
    yield Table("What differs between vehicles of the class", head, rows, numbers=True)
    cells = []
    for name, *ends in predicted._answers():
        label, size, unit = shown_as(name)
        own = result.metrics.get(name) if name in result.metrics else None
        numbers = ("–" if number is None else _number(number / size) for number in (own, *ends))
        cells.append((label, *numbers, unit))
    yield Table(
        f"This run beside {100.0 * predicted.share:g} % of the vehicles of its class",
        ("quantity", "this run", "low", "median", "high", "unit"),
        cells,
        numbers=True,
    )
    yield outcome_table(predicted.study, "Outcomes of the vehicles of its class")
    yield Caution(predicted.caution)


def _number(value: float) -> str:
    """Return a number as a table shows it: no power of ten up to seven digits, rounding errors as zero."""
    if abs(value) < _ROUNDING:
        return "0"
    return f"{value:,.0f}" if 1e4 <= abs(value) < 1e7 else f"{value:.4g}"


def headline_table(result: Result, bands: ClassBands | str) -> Table:
    """Return the headline numbers with their bands."""
    rows = []
    for name in HEADLINES:
        shown = METRICS[name].shown
        if shown is not None and name in result.metrics:
            value = format(result.metrics[name] / shown.size, shown.form)
            rows.append((shown.label, value, band_of(bands, name, shown.size, shown.form), shown.unit))
    return Table("Headline numbers", ("quantity", "value", "80 % of the class", "unit"), rows, numbers=True)
